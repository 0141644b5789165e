// SPDX-License-Identifier: MIT
// The objects 24h, 25h, 64h and 66h of the NS310 (SIE-C718-7 Appendix B), as a table of what a Get returns and a Set
// takes. 66h holds numbers only: every attribute is a settable UINT.
#include <algorithm>

#include "captures/simulator/can_ns310.hpp"

namespace servotrace::simulator {
namespace {

struct Row {
  std::uint8_t class_id;
  std::uint8_t attribute;
  std::uint8_t size;  // bytes
  bool settable;
  std::int64_t initial;
  std::int64_t minimum = INT64_MIN;
  std::int64_t maximum = INT64_MAX;
  std::uint8_t other_size = 0;  // also taken; 0: none
};

constexpr std::int64_t kFar = 99'999'999;

constexpr Row kRows[] = {
    {0x24, 1, 1, false, 10},
    {0x24, 3, 1, false, 1},
    {0x24, 5, 1, false, 0},
    {0x24, 6, 1, true, 1},
    {0x24, 7, 1, true, 1},
    {0x24, 11, 1, true, 0, 0, 1},
    {0x24, 12, 1, true, 0, 0, 1},
    {0x24, 16, 1, false, 0},
    {0x24, 17, 4, false, 0},
    {0x25, 1, 1, false, 46},
    {0x25, 3, 1, true, 0, 0, 1},
    {0x25, 6, 4, true, 0, -kFar, kFar},
    {0x25, 7, 4, true, 400'000, 1},
    {0x25, 8, 4, true, 2'000'000, 1},
    {0x25, 9, 4, true, 2'000'000, 1},
    {0x25, 10, 1, true, 0, 0, 1},
    {0x25, 11, 1, true, 0, 0, 1},
    {0x25, 12, 1, false, 1},
    {0x25, 13, 4, true, 0, -kFar, kFar},
    {0x25, 14, 4, false, 0},
    {0x25, 15, 4, false, 0},
    {0x25, 16, 4, false, 0},
    {0x25, 17, 1, true, 0, 0, 1},
    {0x25, 18, 1, true, 0},
    {0x25, 19, 4, true, 25, 4, 1000},
    {0x25, 20, 1, true, 0, 0, 1},
    {0x25, 21, 1, true, 0, 0, 1},
    {0x25, 22, 4, true, 1, 1},
    {0x25, 23, 1, true, 0, 0, 1},
    {0x25, 24, 1, true, 0, 0, 1},
    {0x25, 26, 4, true, 800, 0, 800},
    {0x25, 27, 4, true, -800, -800, 0},
    {0x25, 30, 2, true, 40, 1, 2000},
    {0x25, 38, 1, true, 5, 0, 255},
    {0x25, 45, 4, true, 262'144, 256, 8'388'352},
    {0x25, 47, 1, true, 0, 0, 1},
    {0x25, 49, 1, true, 0, 0, 2},
    {0x25, 50, 1, false, 0},
    {0x25, 51, 1, false, 0},
    {0x25, 52, 1, true, 0, 0, 1},
    {0x25, 54, 4, true, kFar},
    {0x25, 55, 4, true, -kFar},
    {0x25, 56, 1, false, 0},
    {0x25, 57, 1, false, 0},
    {0x25, 231, 1, true, 0, 0, 1},
    {0x25, 232, 1, true, 0, 0, 1},
    {0x25, 241, 1, true, 0, 0, 1},
    {0x25, 242, 1, true, 0, 0, 1},
    {0x25, 243, 1, true, 0, 0, 1},
    {0x25, 244, 1, false, 0},
    {0x25, 253, 1, true, 0, 0, 1},
    {0x25, 254, 4, true, 10'000, 1, 4'000'000},
    {0x25, 255, 4, true, 5'000, 1, 4'000'000},
    {0x64, 11, 2, true, 1, 0, 1},
    {0x64, 12, 4, true, 600, 1, 240'000},
    {0x64, 13, 4, true, 600, 1, 240'000},
    {0x64, 14, 4, true, 300, 1, 240'000},
    {0x64, 15, 4, true, 0, 0, kFar},
    {0x64, 17, 4, false, 0},
    {0x64, 30, 4, true, 1, 1},
    {0x64, 31, 4, true, 1, 1},
    {0x64, 32, 1, true, 0, 0, 1},
    {0x64, 33, 4, true, 360'000, 1, 1'500'000},
    {0x64, 34, 4, true, 0, 0, 32'767},
    {0x64, 35, 1, true, 0, 0, 1},
    {0x64, 36, 4, true, kFar, -kFar, kFar},
    {0x64, 37, 4, true, -kFar, -kFar, kFar},
    {0x64, 38, 2, true, 0, 0, 3},
    {0x64, 39, 1, true, 0, 0, 3},
    {0x64, 40, 1, true, 0, 0, 2},
    {0x64, 41, 1, true, 0, 0, 3},
    {0x64, 42, 1, true, 0, 0, 0},
    {0x64, 51, 4, true, 24'000, 1, 240'000},
    {0x64, 52, 2, true, 100, 1, 10'000},
    {0x64, 53, 4, true, 100, 1, 10'000},
    {0x64, 54, 4, true, 24'000, 1, 240'000},
    {0x64, 55, 2, true, 100, 1, 10'000},
    {0x64, 56, 1, true, 1, 0, 3},
    {0x64, 58, 1, true, 0, 0, 3},
    {0x64, 60, 4, true, 24'000, 1, 240'000},
    {0x64, 61, 2, true, 100, 1, 10'000},
    {0x64, 62, 2, true, 100, 1, 10'000},
    {0x64, 63, 4, true, 24'000, 1, 240'000},
    {0x64, 64, 2, true, 100, 1, 10'000},
    {0x64, 65, 1, true, 1, 0, 3},
    {0x64, 70, 2, true, 2, 2, 1'000},
    {0x64, 71, 4, true, 24'000, 1, 240'000},
    {0x64, 72, 2, true, 25, 4, 4'000},
    {0x64, 73, 4, true, 24'000, 1, 240'000},
    {0x64, 90, 2, true, 5, 0, 10'000},
    {0x64, 91, 2, true, 0, 0, 100'000, 4},  // its range does not fit its type (B.10)
};

constexpr Row kServopackRow{0x66, 0, 2, true, 0};

const Row* find_row(std::uint8_t class_id, std::uint8_t attribute) {
  if (class_id == 0x66) return attribute >= 10 && attribute <= 191 ? &kServopackRow : nullptr;
  for (const Row& row : kRows) {
    if (row.class_id == class_id && row.attribute == attribute) return &row;
  }
  return nullptr;
}

// Attributes that are one value seen from the network and from the hardware (4.3).
struct Twin {
  std::uint8_t network;   // of 25h
  std::uint8_t hardware;  // of 64h
};
constexpr Twin kTwins[] = {{54, 36}, {55, 37}};

constexpr std::uint16_t key(std::uint8_t class_id, std::uint8_t attribute) {
  return static_cast<std::uint16_t>(class_id << 8U | attribute);
}

}  // namespace

std::int64_t Ns310::parameter(std::uint8_t class_id, std::uint8_t attribute) const {
  if (const auto found = written_.find(key(class_id, attribute)); found != written_.end()) return found->second;
  const Row* row = find_row(class_id, attribute);
  return row == nullptr ? 0 : row->initial;
}

std::int64_t Ns310::attribute_value(std::uint8_t class_id, std::uint8_t attribute) const {
  if (class_id == 0x24) {
    switch (attribute) {
      case 5:
        return alarm_ != 0;
      case 16:
        return at_home_switch();
      default:
        return parameter(class_id, attribute);
    }
  }
  if (class_id != 0x25) return parameter(class_id, attribute);
  switch (attribute) {
    case 7:
      return target_speed_;
    case 8:
      return axis_.acceleration;
    case 9:
      return axis_.deceleration;
    case 11:
      return axis_.moving();
    case 12:
      return !axis_.moving();
    case 13:
    case 15:
      return axis_.position();
    case 14:
    case 16:
      return axis_.speed() < 0 ? -axis_.speed() : axis_.speed();
    case 17:
      return enabled_;
    case 50:
      return cw_limit_;
    case 51:
      return ccw_limit_;
    case 244:
      return emergency_;
    default:
      return parameter(class_id, attribute);
  }
}

void Ns310::attribute_written(std::uint8_t class_id, std::uint8_t attribute, std::int64_t value) {
  written_[key(class_id, attribute)] = value;
  for (const Twin& twin : kTwins) {
    if (class_id == 0x25 && attribute == twin.network) written_[key(0x64, twin.hardware)] = value;
    if (class_id == 0x64 && attribute == twin.hardware) written_[key(0x25, twin.network)] = value;
  }
  if (class_id != 0x25) return;
  switch (attribute) {
    case 7:
      target_speed_ = value;
      break;
    case 8:
      axis_.acceleration = value;
      break;
    case 9:
      axis_.deceleration = value;
      break;
    case 13:
      axis_.set_position(value);
      break;
    default:
      break;
  }
}

ExplicitReply Ns310::serve(const ExplicitRequest& request) {
  catch_up();
  switch (request.class_id) {
    case 0x24:
    case 0x25:
    case 0x64:
    case 0x66:
      return serve_attribute(request);
    case 0x26:
      return serve_sequencer(request);
    case 0x27:
      return serve_block(request);
    default:
      return ExplicitReply::error(status::kObjectDoesNotExist);
  }
}

ExplicitReply Ns310::serve_attribute(const ExplicitRequest& request) {
  if (request.instance != 1) return ExplicitReply::error(status::kObjectDoesNotExist);
  const bool reads = request.service == service::kGetAttributeSingle;
  if (!reads && request.service != service::kSetAttributeSingle)
    return ExplicitReply::error(status::kServiceNotSupported);
  if (request.data.empty()) return ExplicitReply::error(status::kNotEnoughData);
  const std::uint8_t attribute = request.data[0];
  const Row* row = find_row(request.class_id, attribute);
  if (row == nullptr) return ExplicitReply::error(status::kAttributeNotSupported);
  if (reads) {
    ExplicitReply reply;
    const auto value = static_cast<std::uint64_t>(attribute_value(request.class_id, attribute));
    for (unsigned i = 0; i < row->size; ++i) reply.data.push_back(static_cast<std::uint8_t>(value >> (8U * i) & 0xFFU));
    return reply;
  }
  if (!row->settable) return ExplicitReply::error(status::kAttributeNotSettable);
  const Bytes bytes = request.data.subspan(1);
  const bool other = row->other_size != 0 && bytes.size() == row->other_size;
  if (bytes.size() < row->size) return ExplicitReply::error(status::kNotEnoughData);
  if (bytes.size() > row->size && !other) return ExplicitReply::error(status::kTooMuchData);
  std::uint32_t raw = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) raw |= std::uint32_t{bytes[i]} << (8U * i);
  const std::int64_t value = bytes.size() == 4 ? static_cast<std::int32_t>(raw) : static_cast<std::int64_t>(raw);
  if (value < row->minimum || value > row->maximum) return ExplicitReply::error(status::kInvalidAttributeValue);
  attribute_written(request.class_id, attribute, value);
  return {};
}

}  // namespace servotrace::simulator
