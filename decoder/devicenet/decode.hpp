// SPDX-License-Identifier: MIT
// Explicit messages: what a request or a response says, by its body format, and the segments that show it.
#pragma once

#include <cstdint>
#include <optional>

#include "decoder/core/small_vector.hpp"
#include "decoder/devicenet/layouts.hpp"
#include "decoder/pipeline/dissection.hpp"

namespace servotrace::devicenet {

inline constexpr std::uint8_t kGetAttributesAll = 0x01;
inline constexpr std::uint8_t kGetAttributeList = 0x03;
inline constexpr std::uint8_t kResetService = 0x05;
inline constexpr std::uint8_t kGetAttribute = 0x0E;
inline constexpr std::uint8_t kSetAttribute = 0x10;
inline constexpr std::uint8_t kErrorService = 0x14;  // without the response bit: 94h
inline constexpr std::uint8_t kAllocateService = 0x4B;
inline constexpr std::uint8_t kReleaseService = 0x4C;

// Why a message is malformed; argument 0 of DN304.
enum class Malformation : std::uint8_t {
  kEmpty,
  kHeaderOnly,
  kNoCount,
  kNoPath,
  kNoErrorCodes,
  kNoAckStatus,
  kNoChoice,
  kNoAttribute,
  kNone,
};

struct Request {
  Malformation malformed = Malformation::kNone;
  const Layout* layout = nullptr;  // of the bytes in front of the attribute; nullptr: too short for any
  std::uint8_t header = 0;         // XID and MAC ID, without the fragment bit
  std::uint8_t service = 0;
  bool response_bit = false;
  std::uint16_t class_id = 0;
  std::uint16_t instance = 0;
  std::int32_t attribute = -1;
  std::uint32_t data_offset = 0;  // of what follows the attribute
};

struct Response {
  Malformation malformed = Malformation::kNone;
  const Layout* layout = nullptr;
  std::uint8_t header = 0;
  std::uint8_t service = 0;  // without the response bit
  bool response_bit = false;
  bool is_error = false;
  std::uint8_t general_status = 0;
  std::uint8_t additional_status = 0xFF;
  std::uint32_t data_offset = 2;
};

// `message` begins with the header. `body_format`: 0 to 4, others are taken as 0.
Request parse_request(Bytes message, std::uint8_t body_format);
// `request_service`: of the request it answers, where known (an allocation's answer has a layout of its own).
Response parse_response(Bytes message, std::optional<std::uint8_t> request_service);

// The layouts of the values in a message, in their order; empty where they are not known.
using Values = SmallVector<const Layout*, 16>;

// Adds the segments of a message that lies at `base.offset` of `base.buffer`. `values`: of the data behind the
// attribute, or behind the service. `data_elsewhere`: the drive's session shows the data.
void show_request(Dissection& dissection, const Segment& base, Bytes message, const Request& request,
                  const Values& values, bool data_elsewhere);
void show_response(Dissection& dissection, const Segment& base, Bytes message, const Response& response,
                   const Values& values, bool data_elsewhere);
// One segment of `layout` over `length` bytes at `offset` behind `base.offset`; nothing where `length` is 0.
void show(Dissection& dissection, const Segment& base, const Layout& layout, std::size_t offset, std::size_t length);

}  // namespace servotrace::devicenet
