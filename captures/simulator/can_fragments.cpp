// SPDX-License-Identifier: MIT
#include "captures/simulator/can_fragments.hpp"

#include <algorithm>

namespace servotrace::simulator {
namespace {

constexpr std::size_t kIoPayload = 7;
constexpr std::size_t kExplicitPayload = 6;
constexpr std::uint8_t kFragmentBit = 0x80;
constexpr std::uint8_t kOnlyFragment = 0x3F;  // the count of a first fragment that is the last too

std::uint8_t mark(std::size_t index, std::size_t count) {
  const std::uint8_t type = index == 0 ? fragment::kFirst : index + 1 == count ? fragment::kLast : fragment::kMiddle;
  return static_cast<std::uint8_t>(type | (index & fragment::kCountMask));
}

}  // namespace

std::vector<ByteVector> split_io(Bytes message) {
  if (message.empty()) return {ByteVector{}};
  const std::size_t count = (message.size() + kIoPayload - 1) / kIoPayload;
  std::vector<ByteVector> frames;
  for (std::size_t i = 0; i < count; ++i) {
    const Bytes part = message.subspan(i * kIoPayload, std::min(kIoPayload, message.size() - i * kIoPayload));
    ByteVector frame{count == 1 ? kOnlyFragment : mark(i, count)};
    frame.insert(frame.end(), part.begin(), part.end());
    frames.push_back(std::move(frame));
  }
  return frames;
}

std::vector<ByteVector> split_explicit(Bytes message) {
  if (message.size() <= 8) return {ByteVector(message.begin(), message.end())};
  const Bytes body = message.subspan(1);
  const std::size_t count = (body.size() + kExplicitPayload - 1) / kExplicitPayload;
  std::vector<ByteVector> frames;
  for (std::size_t i = 0; i < count; ++i) {
    const Bytes part =
        body.subspan(i * kExplicitPayload, std::min(kExplicitPayload, body.size() - i * kExplicitPayload));
    ByteVector frame{static_cast<std::uint8_t>(message[0] | kFragmentBit), mark(i, count)};
    frame.insert(frame.end(), part.begin(), part.end());
    frames.push_back(std::move(frame));
  }
  return frames;
}

std::optional<ByteVector> IoAssembler::add(Bytes payload) {
  if (payload.empty()) {
    open_ = false;
    return ByteVector{};
  }
  const std::uint8_t type = payload[0] & fragment::kTypeMask;
  const std::uint8_t count = payload[0] & fragment::kCountMask;
  const Bytes part = payload.subspan(1);
  if (type == fragment::kFirst) {
    message_.assign(part.begin(), part.end());
    next_ = 1;
    open_ = count != kOnlyFragment;
    if (!open_) return message_;
    return std::nullopt;
  }
  if (!open_ || count != next_ || type == fragment::kAcknowledge) {
    open_ = false;
    return std::nullopt;
  }
  message_.insert(message_.end(), part.begin(), part.end());
  next_ = (next_ + 1U) & fragment::kCountMask;
  if (type != fragment::kLast) return std::nullopt;
  open_ = false;
  return message_;
}

ExplicitAssembler::Step ExplicitAssembler::add(Bytes payload) {
  const std::uint8_t header = payload[0];
  const std::uint8_t type = payload[1] & fragment::kTypeMask;
  const std::uint8_t count = payload[1] & fragment::kCountMask;
  const Bytes part = payload.subspan(2);
  const auto acknowledge = [&](std::uint8_t status) {
    return ByteVector{header, static_cast<std::uint8_t>(fragment::kAcknowledge | count), status};
  };
  if (type == fragment::kFirst) {
    message_.assign(1, static_cast<std::uint8_t>(header & ~kFragmentBit));
    next_ = 1;
    open_ = true;
  } else if (open_ && type == fragment::kMiddle && count == ((next_ - 1U) & fragment::kCountMask)) {
    return {std::nullopt, acknowledge(0)};  // repeated: its acknowledgement was lost
  } else if (!open_ || count != next_) {
    open_ = false;
    return {};
  } else {
    next_ = (next_ + 1U) & fragment::kCountMask;
  }
  if (message_.size() + part.size() > capacity_) {
    open_ = false;
    return {std::nullopt, acknowledge(1)};
  }
  message_.insert(message_.end(), part.begin(), part.end());
  if (type != fragment::kLast) return {std::nullopt, acknowledge(0)};
  open_ = false;
  return {message_, acknowledge(0)};
}

}  // namespace servotrace::simulator
