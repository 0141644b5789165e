// SPDX-License-Identifier: MIT
// What a DeviceNet drive profile is: its messages, its objects, and a session that judges its traffic. The DeviceNet
// stage finds out which node is which drive and hands the session whole messages (fragments joined, requests matched).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "decoder/core/layout.hpp"
#include "decoder/devicenet/objects.hpp"
#include "decoder/pipeline/context.hpp"
#include "decoder/pipeline/summary.hpp"

namespace servotrace {

// A whole message. `bytes` live until the call returns. `first_frame` is the frame of its first fragment (or this one).
struct Message {
  Bytes bytes;
  Buffer buffer = Buffer::kFrame;  // where a segment over it must point
  std::uint32_t offset = 0;        // of bytes[0] in that buffer
  std::uint64_t first_frame = 0;
  // The bytes of the frame pushed that carry (part of) the message, for highlighting.
  ByteRange in_frame;
};

// An explicit request, or a response with the request it answers.
struct ExplicitExchange {
  std::uint8_t service = 0;  // without the response bit
  std::uint16_t class_id = 0;
  std::uint16_t instance = 0;
  std::int32_t attribute = -1;  // -1: the service names none
  Bytes request_data;           // behind the attribute; valid until the call returns
  std::uint64_t request_frame = 0;
  TimeNs request_time_ns = 0;
  // Of a response only:
  bool is_response = false;
  bool is_error = false;
  std::uint8_t general_status = 0;
  std::uint8_t additional_status = 0xFF;
  Message response;  // data behind the service byte (success)
  Message request;   // of a request: the data behind the attribute
};

class DriveSession {
 public:
  DriveSession() = default;
  DriveSession(const DriveSession&) = delete;
  DriveSession& operator=(const DriveSession&) = delete;
  virtual ~DriveSession() = default;

  // Poll data master to drive and back, whole. Not called for zero-length (idle) messages, nor for lengths that are not
  // the profile's (DN203). `guessed`: decode only, raise nothing.
  virtual void on_command(const Context& context, const Message& message) = 0;
  virtual void on_response(const Context& context, const Message& message) = 0;
  // An explicit request to, or a response of, this node. Also adds segments for the data it knows.
  virtual void on_explicit(const Context& context, const ExplicitExchange& exchange) = 0;
  // Any other frame of the same bus: deadlines may have passed. Cheap.
  virtual void on_time(const Context& context) = 0;
  // False where on_time() would do nothing until the next message.
  bool waits() const { return waits_; }
  // The node started (its own Duplicate MAC ID check, or a completed Reset): what it kept in RAM is gone.
  virtual void on_start(const Context& context) = 0;
  // Records were lost: nothing that was seen before may be compared with what follows.
  virtual void on_gap() = 0;
  virtual void on_finish(const Context& context) = 0;
  // True where the drive reported motion in its last response (DN206).
  virtual bool is_moving() const = 0;
  virtual void summarise(NodeSummary& summary, std::vector<Statistic>& statistics) const = 0;

 protected:
  bool waits_ = true;  // set by whatever may begin to wait, taken back by on_time()
};

struct DriveProfile {
  std::string_view key;                       // "yaskawa-ns310"
  std::string_view title;                     // "Yaskawa SGDH with NS310"
  std::string_view protocol;                  // of its layouts and derived fields: "ns310"
  std::uint8_t command_size = 0;              // bytes of poll data master to drive, 0: unknown
  std::uint8_t response_size = 0;             // bytes of poll data drive to master, 0: unknown
  std::span<const std::uint16_t> vendor_ids;  // Identity attribute 1; empty: never recognised by identity
  std::int32_t product_code = -1;             // Identity attribute 3 with one of vendor_ids; -1: not used
  std::string_view product_name;              // Identity attribute 7, prefix; empty: not used
  std::span<const devicenet::ObjectClass> objects;
  std::span<const Layout* const> layouts;
  std::span<const Field* const> derived;  // fields no single frame holds
  // decode_only: guessed drive; segments are added, no rule is raised. `owner`: the node's findings.
  std::unique_ptr<DriveSession> (*make_session)(const Settings& settings, const NodeRef& node, OwnerId owner,
                                                bool decode_only) = nullptr;
};

}  // namespace servotrace
