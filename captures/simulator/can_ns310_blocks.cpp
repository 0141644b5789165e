// SPDX-License-Identifier: MIT
// Command blocks: the block sequencer 26h and the blocks 27h (SIE-C718-7 5.5, B.8, B.9).
#include <algorithm>

#include "captures/simulator/can_ns310.hpp"

namespace servotrace::simulator {
namespace {

constexpr std::int64_t kDelayUnitMs = 8;
constexpr std::uint8_t kFaultInvalid = 1;
constexpr std::uint8_t kFaultTimeout = 2;
constexpr std::uint8_t kFaultExecution = 3;

// Bytes of attributes 1..7 of a block, by its command (Tables 5.5-5.16); 0: the command has no such attribute.
std::array<std::uint8_t, 8> block_sizes(std::int64_t command) {
  switch (command) {
    case 0x01:
      return {0, 1, 1, 1, 1, 1, 4, 0};
    case 0x02:
      return {0, 1, 1, 1, 1, 1, 4, 4};
    case 0x03:
    case 0x04:
      return {0, 1, 1, 1, 1, 1, 1, 4};
    case 0x06:
      return {0, 1, 1, 4, 0, 0, 0, 0};
    case 0x07:
    case 0x08:
      return {0, 1, 1, 4, 4, 1, 0, 0};
    case 0x09:
      return {0, 1, 1, 4, 0, 0, 0, 0};
    case 0x10:
      return {0, 1, 1, 4, 4, 0, 0, 0};
    default:
      return {0, 1, 1, 0, 0, 0, 0, 0};
  }
}

std::int64_t number(Bytes bytes) {
  std::uint32_t raw = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) raw |= std::uint32_t{bytes[i]} << (8U * i);
  return bytes.size() == 4 ? static_cast<std::int32_t>(raw) : static_cast<std::int64_t>(raw);
}

void append(ByteVector& bytes, std::int64_t value, unsigned size) {
  for (unsigned i = 0; i < size; ++i)
    bytes.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8U * i) & 0xFFU));
}

}  // namespace

void Ns310::start_block(std::uint8_t number_of_first) {
  if (!ready_to_move() || in_blocks_) return;
  if (number_of_first == 0 || blocks_.find(number_of_first) == blocks_.end()) {
    fail_block(kFaultInvalid);
    return;
  }
  block_fault_ = false;
  block_fault_code_ = 0;
  in_blocks_ = true;
  next_block_ = number_of_first;
  block_waits_ = false;
  executing_ = number_of_first;
}

void Ns310::fail_block(std::uint8_t code) {
  block_fault_ = true;
  block_fault_code_ = code;
  in_blocks_ = false;
  executing_ = 0;
}

void Ns310::run_block() {
  executing_ = next_block_;
  const auto found = blocks_.find(executing_);
  if (found == blocks_.end()) {
    fail_block(kFaultInvalid);
    return;
  }
  const Block& block = found->second;
  next_block_ = static_cast<std::uint8_t>(block[2]);
  const std::int64_t compared = axis_.position();
  switch (block[1]) {
    case 0x01:
      if (block[3] == 0x25 && (block[5] == 8 || block[5] == 9)) {
        (block[5] == 8 ? axis_.acceleration : axis_.deceleration) = std::max<std::int64_t>(block[6], 1);
      } else if (block[3] != 0x64) {
        fail_block(kFaultExecution);
      }
      break;
    case 0x02:
      block_waits_ = true;
      block_left_ms_ = block[6] == 0 ? INT64_MAX : block[6];
      break;
    case 0x03:
      if (compared > block[7]) next_block_ = static_cast<std::uint8_t>(block[6]);
      break;
    case 0x04:
      if (compared < block[7]) next_block_ = static_cast<std::uint8_t>(block[6]);
      break;
    case 0x06:
      block_waits_ = true;
      block_left_ms_ = block[3] / kDelayUnitMs * kDelayUnitMs;
      break;
    case 0x07:
    case 0x08:
      axis_.move_to((block[5] != 0 ? axis_.position() : 0) + block[3], std::max<std::int64_t>(block[4], 1));
      operation_ = Operation::kPositioning;
      block_waits_ = block[1] == 0x08;
      break;
    case 0x09:
      axis_.change_speed(std::max<std::int64_t>(block[3], 1));
      break;
    case 0x10:
      if (!homed_) {
        fail_block(kFaultExecution);
        return;
      }
      axis_.move_to(block[3], std::max<std::int64_t>(block[4], 1));
      operation_ = Operation::kPositioning;
      block_waits_ = true;
      break;
    default:
      fail_block(kFaultInvalid);
      break;
  }
}

void Ns310::tick_block() {
  if (block_waits_) {
    const std::int64_t command = blocks_[executing_][1];
    if (command == 0x02) {
      if (axis_.position() == blocks_[executing_][7]) {
        block_waits_ = false;
      } else if (--block_left_ms_ <= 0) {
        fail_block(kFaultTimeout);
        return;
      }
    } else if (command == 0x06) {
      block_waits_ = --block_left_ms_ > 0;
    } else {
      block_waits_ = axis_.moving();
    }
    if (block_waits_) return;
    if (next_block_ == 0) {
      in_blocks_ = false;
      executing_ = 0;
    }
    return;
  }
  if (next_block_ == 0) {  // the last command did not wait: the chain ends with its motion
    if (axis_.moving()) return;
    in_blocks_ = false;
    executing_ = 0;
    return;
  }
  run_block();
}

ExplicitReply Ns310::serve_block(const ExplicitRequest& request) {
  if (request.instance == 0) return ExplicitReply::error(status::kObjectDoesNotExist);
  const bool writes = request.service == service::kSetAttributeSingle || request.service == service::kSetAttributesAll;
  if (writes && (in_blocks_ || alarm_ != 0)) return ExplicitReply::error(status::kObjectStateConflict);  // 5.6.3
  Block block = {};
  if (const auto found = blocks_.find(request.instance); found != blocks_.end()) block = found->second;
  if (request.service == service::kSetAttributesAll) {
    if (request.data.empty()) return ExplicitReply::error(status::kNotEnoughData);
    const std::array<std::uint8_t, 8> sizes = block_sizes(request.data[0]);
    block = {};
    std::size_t offset = 0;
    for (std::size_t i = 1; i < sizes.size(); ++i) {
      if (offset + sizes[i] > request.data.size()) return ExplicitReply::error(status::kNotEnoughData);
      block[i] = number(request.data.subspan(offset, sizes[i]));
      offset += sizes[i];
    }
    if (offset < request.data.size()) return ExplicitReply::error(status::kTooMuchData);
    blocks_[request.instance] = block;
    return {};
  }
  const std::array<std::uint8_t, 8> sizes = block_sizes(block[1]);
  if (request.service == service::kGetAttributesAll) {
    ExplicitReply reply;
    for (std::size_t i = 1; i < sizes.size(); ++i) append(reply.data, block[i], sizes[i]);
    return reply;
  }
  if (request.data.empty()) return ExplicitReply::error(status::kNotEnoughData);
  const std::uint8_t attribute = request.data[0];
  if (attribute == 0 || attribute > 7) return ExplicitReply::error(status::kAttributeNotSupported);
  if (request.service == service::kGetAttributeSingle) {
    ExplicitReply reply;
    append(reply.data, block[attribute], std::max<std::uint8_t>(sizes[attribute], 1));
    return reply;
  }
  if (request.service != service::kSetAttributeSingle) return ExplicitReply::error(status::kServiceNotSupported);
  const Bytes value = request.data.subspan(1);
  if (attribute == 1) {
    if (value.size() != 1) return ExplicitReply::error(status::kNotEnoughData);
    block = {};  // attributes 2 to 7 are initialised with a new command
    block[1] = value[0];
  } else {
    if (value.size() < sizes[attribute]) return ExplicitReply::error(status::kNotEnoughData);
    if (sizes[attribute] == 0) return ExplicitReply::error(status::kAttributeNotSettable);
    if (value.size() > sizes[attribute]) return ExplicitReply::error(status::kTooMuchData);
    block[attribute] = number(value);
  }
  blocks_[request.instance] = block;
  return {};
}

ExplicitReply Ns310::serve_sequencer(const ExplicitRequest& request) {
  if (request.instance != 1) return ExplicitReply::error(status::kObjectDoesNotExist);
  if (request.data.empty()) return ExplicitReply::error(status::kNotEnoughData);
  const std::uint8_t attribute = request.data[0];
  if (request.service == service::kSetAttributeSingle) {
    if (request.data.size() != 2) return ExplicitReply::error(status::kNotEnoughData);
    if (attribute == 1) {
      next_block_ = request.data[1];
    } else if (attribute == 2) {
      if (request.data[1] != 0) start_block(next_block_);
    } else {
      return ExplicitReply::error(attribute <= 5 ? status::kAttributeNotSettable : status::kAttributeNotSupported);
    }
    return {};
  }
  if (request.service != service::kGetAttributeSingle) return ExplicitReply::error(status::kServiceNotSupported);
  switch (attribute) {
    case 1:
      return {0, 0xFF, {next_block_}};
    case 2:
      return {0, 0xFF, {static_cast<std::uint8_t>(in_blocks_)}};
    case 3:
      return {0, 0xFF, {executing_}};
    case 4:
      return {0, 0xFF, {static_cast<std::uint8_t>(block_fault_)}};
    case 5:
      block_fault_ = false;  // reading the code resets the fault (B.8)
      return {0, 0xFF, {block_fault_code_}};
    default:
      return ExplicitReply::error(status::kAttributeNotSupported);
  }
}

}  // namespace servotrace::simulator
