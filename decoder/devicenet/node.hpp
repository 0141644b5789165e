// SPDX-License-Identifier: MIT
// What is known of one node (MAC ID) of a bus, and of its connections. Everything begins unknown.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "decoder/core/durations.hpp"
#include "decoder/devicenet/decode.hpp"
#include "decoder/devicenet/fragments.hpp"
#include "decoder/devicenet/machines.hpp"
#include "decoder/profiles/profile.hpp"

namespace servotrace::devicenet {

// An explicit request that waits for its response.
struct PendingRequest {
  enum class State : std::uint8_t {
    kFree,
    kOpen,       // no response yet
    kAnswering,  // the first fragment of its response came
    kLate,       // reported as unanswered: a late response is no wonder
  };
  State state = State::kFree;
  bool malformed = false;  // may stay without a response
  bool silent = false;     // a missing response is no finding
  std::uint16_t port = 0;  // the CAN identifier it came on
  Request request;
  std::uint64_t frame = 0;
  TimeNs time_ns = 0;
  std::uint16_t data_size = 0;
  std::array<std::uint8_t, 128> data = {};  // behind the attribute; longer data is cut

  Bytes request_data() const { return Bytes(data).first(data_size); }
};

// The explicit messages between a node and its masters: of the predefined set, or of a dynamic connection.
struct ExplicitChannel {
  std::uint16_t request_id = 0;      // CAN identifier of requests; of the predefined set also the unconnected port's
  std::uint16_t unconnected_id = 0;  // 0: none
  std::uint16_t response_id = 0;
  std::uint8_t body_format = 0;
  // The bits of the header that a request and its response share. On a dynamic connection each holds the other end's
  // MAC ID, so that only the XID is the same.
  std::uint8_t header_mask = 0x7F;
  Transfer request{true};
  Transfer response{true};
  std::array<PendingRequest, 4> pending = {};
  bool used = false;  // a request was answered, at used_time_ns for the last time
  TimeNs used_time_ns = 0;
};

enum class Known : std::uint8_t { kUnknown, kNo, kYes };

// How a node's drive profile was found, strongest last.
enum class Recognised : std::uint8_t { kNone, kGuessed, kIdentity, kConfigured };

struct Learnt {
  std::int64_t value = 0;
  std::uint64_t frame = 0;
};

struct PollConnection {
  PollState state = PollState::kUnknown;
  Transfer command{false};
  Transfer response{false};
  // The last poll command, whole.
  bool awaiting = false;  // its response is due
  bool has_command = false;
  std::uint32_t command_bytes = 0;
  std::uint64_t command_frame = 0;
  TimeNs command_time_ns = 0;
  // The last beginning of a poll command.
  bool polled = false;
  TimeNs polled_time_ns = 0;
  std::uint64_t polled_frame = 0;
  // Watchdog: four times the expected packet rate.
  std::optional<Learnt> packet_rate_ms;
  TimeNs packet_rate_time_ns = 0;
  bool polled_since_rate = false;
  bool watched = false;
  bool too_short = false;  // DN210: it times out in normal traffic, which is no finding of its own
  // Sizes the device told, bytes.
  std::optional<Learnt> command_size;
  std::optional<Learnt> response_size;
  bool data_seen = false;           // a poll response with data was seen
  bool size_seen = false;           // a whole message had the profile's size
  std::uint8_t misfits = 0;         // frames that fit no fragmentation before that
  std::uint8_t guess_commands = 0;  // whole fragmented messages of the size a guess asks for, in a row
  std::uint8_t guess_responses = 0;
  Durations interval;
  Durations interval_change;  // from one interval to the next
  DurationNs last_interval_ns = -1;
  Durations answer;
};

// Another I/O connection's messages of one direction: decoded, not supervised.
struct IoStream {
  Transfer transfer{false};
  std::optional<Learnt> size;  // bytes, as the device told
};

// Of a frame in Node::last_frames: 16 message IDs of group 1, 8 of group 2, 8 of group 3.
constexpr std::size_t place_of(const Identifier& id) {
  return id.group == 1 ? id.message_id & 15U : (id.group == 2 ? 16U : 24U) + (id.message_id & 7U);
}

// The last frame of one CAN identifier.
struct LastFrame {
  std::uint64_t frame = 0;  // 0: none
  TimeNs time_ns = 0;
};

struct Node {
  NodeRef ref;  // channel kNone
  OwnerId owner{};
  OwnerId poll_owner{};
  OwnerId explicit_owner{};
  OwnerId unconnected_owner{};

  // Start, and who it is.
  StartState start = StartState::kUnknown;
  TimeNs check_time_ns = 0;  // of its first Duplicate MAC ID request
  std::uint64_t check_frame = 0;
  bool start_untold = false;  // its drive session has not heard of its start yet
  bool has_pair = false;
  bool pair_certain = false;  // not where the node was on line and its own pair never seen
  std::uint16_t vendor_id = 0;
  std::uint32_t serial_number = 0;
  bool has_challenger = false;
  std::uint16_t challenger_vendor = 0;
  std::uint32_t challenger_serial = 0;
  bool active = false;  // it was heard, at active_time_ns for the last time
  TimeNs active_time_ns = 0;
  bool heard = false;  // since the capture began, its last check or its Reset

  // Allocation.
  Known explicit_connection = Known::kUnknown;
  std::int16_t master = kNoMacId;       // the owner, as the allocation showed it
  std::int16_t master_seen = kNoMacId;  // the MAC ID in the last explicit header
  std::optional<Learnt> choice;         // allocated connections, by bit
  bool exchanged = false;               // a request and its response were seen since the last gap
  std::uint32_t late_allowance = 0;     // responses still owed to requests reported as unanswered

  PollConnection poll;
  IoStream change_of_state_data;               // of the node, on 340h + n
  std::optional<Learnt> change_of_state_size;  // of the master's, on 405h + 8n
  IoStream multicast_response;
  ExplicitChannel channel;
  Durations explicit_answer;

  std::array<LastFrame, 32> last_frames = {};  // of its I/O and explicit messages, by group and message ID

  // Identity attributes read.
  std::optional<Learnt> identity_vendor;
  std::optional<Learnt> identity_product;
  std::optional<Learnt> explicit_rate_ms;
  std::optional<Learnt> baud_rate;

  const DriveProfile* profile = nullptr;
  Recognised recognised = Recognised::kNone;
  std::uint64_t recognised_frame = 0;
  std::unique_ptr<DriveSession> session;
  TimeNs response_time_ns = 0;  // of the last poll response with data handed to the session
  std::uint64_t response_frame = 0;
  bool responded = false;

  // The master to show as the other end, kNoMacId where unknown.
  std::int16_t other_end() const { return master != kNoMacId ? master : master_seen; }
  // How its drive was recognised, for findings that rest on it.
  Basis drive_basis() const {
    if (recognised == Recognised::kConfigured) return {BasisKind::kConfigured, 0};
    if (recognised == Recognised::kIdentity) return {BasisKind::kCapture, recognised_frame};
    return {};
  }
  bool known_drive() const { return profile != nullptr && recognised >= Recognised::kIdentity; }
  bool change_of_state() const { return choice && (choice->value & 0x30) != 0; }
  // The identifiers of the poll connection are those of a change-of-state or cyclic one.
  bool change_of_state_only() const { return change_of_state() && (choice->value & 0x02) == 0; }
};

// A connection opened by unconnected messages.
struct DynamicConnection {
  std::uint8_t client = 0;
  std::uint8_t server = 0;
  std::uint16_t instance = 0;
  ExplicitChannel channel;
  LastFrame last_request;
  LastFrame last_response;
};

// An Open request that waits for its answer.
struct PendingOpen {
  bool used = false;
  std::uint8_t client = 0;
  std::uint8_t server = 0;
  std::uint8_t header = 0;
  std::uint8_t service = 0;
  std::uint8_t group_select = 0;
  std::uint8_t message_id = 0;
  std::uint16_t instance = 0;  // of a Close
  std::uint64_t frame = 0;
  TimeNs time_ns = 0;
};

}  // namespace servotrace::devicenet
