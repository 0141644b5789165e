// SPDX-License-Identifier: MIT
// The objects every slave has: identity 01h, DeviceNet 03h, connection 05h (DeviceNet link layer).
#include <algorithm>

#include "captures/simulator/can_slave.hpp"

namespace servotrace::simulator {
namespace {

ByteVector number(std::uint32_t value, unsigned byte_count) {
  ByteVector bytes;
  for (unsigned i = 0; i < byte_count; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8U * i) & 0xFFU));
  return bytes;
}
ExplicitReply success(ByteVector data) { return {0, 0xFF, std::move(data)}; }

constexpr std::uint8_t kStateConfiguring = 1;
constexpr std::uint8_t kStateEstablished = 3;

}  // namespace

ExplicitReply Slave::serve_any(const ExplicitRequest& request, std::uint8_t header, bool unconnected) {
  (void)header;
  if (request.class_id == 0x03 && request.service == service::kAllocate) return allocate(request);
  if (request.class_id == 0x03 && request.service == service::kRelease) return release(request);
  if (unconnected) return ExplicitReply::error(status::kServiceNotSupported);
  switch (request.class_id) {
    case 0x01:
      return identity(request);
    case 0x03:
      return devicenet(request);
    case 0x05:
      return connection(request);
    default:
      return serve(request);
  }
}

ExplicitReply Slave::allocate(const ExplicitRequest& request) {
  if (request.data.size() < 2) return ExplicitReply::error(status::kNotEnoughData);
  const std::uint8_t wanted = request.data[0];
  const std::uint8_t master = request.data[1] & 0x3FU;
  if (wanted == 0) return ExplicitReply::error(status::kInvalidAttributeValue, 0x02);
  if (allocated_ != 0 && master != owner_) return ExplicitReply::error(status::kObjectStateConflict, 0x01);
  if ((wanted & ~(choice::kExplicit | choice::kPoll)) != 0)
    return ExplicitReply::error(status::kResourceUnavailable, 0x02);
  if ((wanted & choice::kPoll) != 0 && settings_.command_size == 0)
    return ExplicitReply::error(status::kResourceUnavailable, 0x02);
  if ((wanted & allocated_) != 0) return ExplicitReply::error(status::kAlreadyInState, 0x02);
  owner_ = master;
  allocated_ |= wanted;
  if ((wanted & choice::kPoll) != 0) {
    poll_established_ = false;
    polled_ = false;
    poll_epr_ms_ = 0;
  }
  return success({0});
}

ExplicitReply Slave::release(const ExplicitRequest& request) {
  if (request.data.empty()) return ExplicitReply::error(status::kNotEnoughData);
  const std::uint8_t given = request.data[0];
  if (given == 0) return ExplicitReply::error(status::kInvalidAttributeValue, 0x02);
  if ((given & allocated_) == 0) return ExplicitReply::error(status::kAlreadyInState, 0x02);
  allocated_ = static_cast<std::uint8_t>(allocated_ & ~given);
  if ((given & choice::kPoll) != 0 && poll_established_) {
    poll_established_ = false;
    lose_master();
  }
  return success({});
}

ExplicitReply Slave::identity(const ExplicitRequest& request) {
  if (request.instance != 1) return ExplicitReply::error(status::kObjectDoesNotExist);
  if (request.service == service::kReset) return success({});
  if (request.service != service::kGetAttributeSingle) return ExplicitReply::error(status::kServiceNotSupported);
  if (request.data.empty()) return ExplicitReply::error(status::kNotEnoughData);
  const Identity& own = settings_.identity;
  switch (request.data[0]) {
    case 1:
      return success(number(own.vendor_id, 2));
    case 2:
      return success(number(own.device_type, 2));
    case 3:
      return success(number(own.product_code, 2));
    case 4:
      return success({own.major, own.minor});
    case 5:
      return success(number(allocated_ != 0 ? 1U : 0U, 2));  // bit 0: owned
    case 6:
      return success(number(own.serial_number, 4));
    case 7: {
      ByteVector text{static_cast<std::uint8_t>(own.product_name.size())};
      text.insert(text.end(), own.product_name.begin(), own.product_name.end());
      return success(text);
    }
    default:
      return ExplicitReply::error(status::kAttributeNotSupported);
  }
}

ExplicitReply Slave::devicenet(const ExplicitRequest& request) {
  if (request.instance != 1) return ExplicitReply::error(status::kObjectDoesNotExist);
  if (request.service != service::kGetAttributeSingle) return ExplicitReply::error(status::kServiceNotSupported);
  if (request.data.empty()) return ExplicitReply::error(status::kNotEnoughData);
  switch (request.data[0]) {
    case 1:
      return success({settings_.mac_id});
    case 2:
      return success({2});  // 500 kbit/s
    case 3:
    case 4:
      return success({0});
    case 5:
      return success({allocated_, allocated_ != 0 ? owner_ : std::uint8_t{0xFF}});
    default:
      return ExplicitReply::error(status::kAttributeNotSupported);
  }
}

ExplicitReply Slave::connection(const ExplicitRequest& request) {
  const bool poll = request.instance == 2;
  if ((request.instance != 1 && !poll) || !has(poll ? choice::kPoll : choice::kExplicit))
    return ExplicitReply::error(status::kObjectDoesNotExist);
  if (request.service == service::kReset) {
    if (poll) arm_watchdog();
    return success({});
  }
  if (request.data.empty()) return ExplicitReply::error(status::kNotEnoughData);
  const std::uint8_t attribute = request.data[0];
  std::uint16_t& epr_ms = poll ? poll_epr_ms_ : explicit_epr_ms_;
  if (request.service == service::kSetAttributeSingle) {
    if (attribute != 9) {
      const bool known = attribute >= 1 && attribute <= 16 && attribute != 10 && attribute != 11;
      return ExplicitReply::error(known ? status::kAttributeNotSettable : status::kAttributeNotSupported);
    }
    if (request.data.size() < 3) return ExplicitReply::error(status::kNotEnoughData);
    if (request.data.size() > 3) return ExplicitReply::error(status::kTooMuchData);
    epr_ms = static_cast<std::uint16_t>(request.data[1] | request.data[2] << 8U);
    if (poll) {
      poll_established_ = true;
      arm_watchdog();
    }
    return success(number(epr_ms, 2));
  }
  if (request.service != service::kGetAttributeSingle) return ExplicitReply::error(status::kServiceNotSupported);
  const std::uint32_t mac_id = settings_.mac_id;
  switch (attribute) {
    case 1:
      return success({poll && !poll_established_ ? kStateConfiguring : kStateEstablished});
    case 2:
      return success({poll ? std::uint8_t{1} : std::uint8_t{0}});
    case 3:
      return success({poll ? std::uint8_t{0x82} : std::uint8_t{0x83}});
    case 4:
      return success(number(poll ? 0x3C0U + mac_id : 0x403U + 8U * mac_id, 2));
    case 5:
      return success(number(0x404U + 8U * mac_id + (poll ? 1U : 0U), 2));
    case 6:
      return success({poll ? std::uint8_t{0x01} : std::uint8_t{0x21}});
    case 7:
      return success(number(poll ? settings_.response_size : 0x00FFU, 2));
    case 8:
      return success(number(poll ? settings_.command_size : 0x00FFU, 2));
    case 9:
      return success(number(epr_ms, 2));
    case 12:
      return success({poll ? std::uint8_t{0} : std::uint8_t{1}});
    case 13:
    case 15:
      return success(number(0, 2));
    case 14:
    case 16:
      return success({});
    default:
      return ExplicitReply::error(status::kAttributeNotSupported);
  }
}

}  // namespace servotrace::simulator
