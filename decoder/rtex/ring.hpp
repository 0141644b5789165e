// SPDX-License-Identifier: MIT
// The state of a ring, at its narrowest owners: ring, node (a place in the connection order), channel. Filled by
// session.cpp and handshake.cpp; the checks only read it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "decoder/core/durations.hpp"
#include "decoder/core/hourly.hpp"
#include "decoder/core/small_vector.hpp"
#include "decoder/pipeline/context.hpp"
#include "decoder/rtex/derived.hpp"
#include "decoder/rtex/knowledge.hpp"
#include "decoder/rtex/machines.hpp"
#include "decoder/rtex/quiet.hpp"
#include "decoder/rtex/views.hpp"

namespace servotrace::rtex {

inline constexpr std::size_t kMaxNodes = 32;
inline constexpr std::uint8_t kWholeRing = 0xFF;  // the place of findings of a whole ring: no node's

// A moment of the capture.
struct Moment {
  std::uint64_t frame = 0;
  TimeNs time_ns = 0;
  std::int64_t cycle = 0;  // communication cycles since the ring's first record
  bool operator==(const Moment&) const = default;
};

// A non-cyclic command the master holds.
struct Hold {
  CommandPart part;
  Moment start;
  bool seen_start = false;      // the capture holds its first record
  bool every_response = false;  // and every response since
  bool echoed = false;          // a response at least one cycle later echoed the code
  Moment echo;                  // the first of them
  bool refused = false;         // with CMD_Error
  bool arguments_echoed = false;
  bool complete = false;           // code, Type_Code and Index echoed, Busy = 0
  bool ended = false;              // the last echo showed ERR, CMD_Error or an alarm: nothing more is expected
  bool homing_complete = false;    // an echo showed Homing_Complete = 1
  bool in_progress = false;        // a response since the start showed In_Progress = 1
  bool stop_bits = false;          // Hard_Stop, Smooth_Stop or Pause was 1
  bool late_start_judged = false;  // RX527
  bool position_known = false;     // the actual position when it started
  std::int32_t position = 0;
  bool not_started = false;  // RX301, RX303: the drive does not start it
  bool operator==(const Hold&) const = default;
};

// What the drive is still working on (the catalogue's "Busy").
struct Process {
  bool busy = false;
  std::uint8_t code = 0;
  std::uint16_t type_code = 0;
  Moment since;
  bool operator==(const Process&) const = default;
};

// RX301 or RX305 on the assumption of the A4N-compatible start mode: the drive may prove it wrong.
struct Withheld {
  bool waiting = false;
  bool arguments = false;  // RX305, else RX301
  CommandPart part;
  std::uint8_t before = 0;  // the code held until then
  Moment at;
  bool operator==(const Withheld&) const = default;
};

struct ChannelState {
  Channel id = Channel::kNone;
  OwnerId owner{};
  Handshake state = Handshake::kUnknown;
  HandshakeStep step = HandshakeStep::kNone;  // of the record being judged
  Hold hold;
  Process process;
  Withheld withheld;
  bool next_not_started = false;  // set by the check that found that the drive does not start the command
  bool operator==(const ChannelState&) const = default;
};

// Update_Counter of a node.
struct CounterState {
  std::uint32_t history = 0;  // two bits a cycle, the newest lowest
  std::uint8_t history_length = 0;
  bool comparable = false;  // the record before was this node's, outside NOP, without a gap
  bool ever_moved = false;  // since the ring runs
  std::uint32_t still = 0;  // records since the last move, where `phase_known`
  bool phase_known = false;
  std::uint32_t active_records = 0;  // outside NOP since the ring runs, saturated
  std::uint32_t nop_records = 0;
  bool nop_moved = false;
  std::uint8_t nop_counter = 0;
  bool unused_reported = false;  // RX211
  bool start_pending = false;    // RX204 waits for the first move
  Moment start;
  std::uint8_t start_counter = 0;
  std::uint32_t misses = 0;  // RX201 and RX202 since the ring runs
  std::int64_t stuck_cycles = 0;
  std::uint64_t last_move_frame = 0;
  bool warned_error = false, warned_warning = false;   // RX206
  std::uint32_t window_records = 0, window_moves = 0;  // for the updating ratio
  bool echo_pending = false;                           // RX205 waits: the response may be a stale one
  Moment echo_at;
  std::uint8_t echo_wanted = 0, echo_seen = 0;
  bool operator==(const CounterState&) const = default;
};

// The profile operation the drive last accepted.
struct ProfileState {
  bool known = false;
  std::uint8_t type_code = 0;
  std::uint8_t latch_sel1 = 0;
  std::int32_t position = 0;
};

struct LatchState {
  bool started1 = false, started2 = false;  // by 51h to 53h, not complete or cancelled as far as shown
  bool shown1 = false, shown2 = false;      // Latch_Comp was shown
  bool complete1 = false, complete2 = false;
};

// Response_Data1 counts as the actual position on the assumption of Pr7.29 once it has followed the command.
struct Following {
  bool has_base = false;
  std::int32_t base_command = 0, base_position = 0;
  bool proven = false;
  std::uint64_t frame = 0;
  bool operator==(const Following&) const = default;
};

// RX705: an active drive inhibit input, and what the commands do about it.
struct InhibitWatch {
  int direction = 0;        // +1 POT, -1 NOT, 0 neither or both
  std::uint64_t frame = 0;  // of the response that showed it
  Basis basis;
  bool stopped = false;                               // the command has stopped or turned round since
  std::int32_t reference = 0;                         // CP: the command position farthest from the input since
  std::int64_t changed = 0;                           // CP: the cycle of the last change
  bool toward = false;                                // the command at hand goes toward the input
  bool operator==(const InhibitWatch& other) const {  // the basis goes with the frame
    return direction == other.direction && frame == other.frame && stopped == other.stopped &&
           reference == other.reference && changed == other.changed && toward == other.toward;
  }
};

// RX706: the command position while the servo is off.
struct OffWatch {
  bool known = false;
  std::int64_t least = 0;     // smallest distance to the actual position since
  std::int32_t at_least = 0;  // the command position then
  std::uint64_t frame_least = 0;
  std::uint32_t moves = 0;  // away from the actual position since
  Moment since;
  bool moves_now = false;
  bool operator==(const OffWatch&) const = default;
};

// RX521, RX525: stop bits and a motion without an end.
struct ProfileWatch {
  bool stopped = false;  // Hard_Stop or Smooth_Stop rose while In_Progress was 1
  std::uint64_t stop_frame = 0;
  Moment endless_since;  // frame 0: not so
};

struct EmergencyInput {
  bool known = false;
  bool active = false;
  bool operator==(const EmergencyInput&) const = default;
};

struct AlarmState {
  bool known = false;  // a status was seen in this run
  bool alarm = false, warning = false;
  bool was_known = false, was_alarm = false, was_warning = false;  // in the run before
  bool alarm_open = false, warning_open = false;                   // RX902, RX903 were said without a code
  bool alarm_first = false, warning_first = false;                 // and as set since before the capture
  Moment alarm_rise, warning_rise;
};

struct Judged {
  RuleId rule{};
  OwnerId owner{};
  std::uint64_t frame = 0;
  TimeNs time_ns = 0;
};

// A string read four characters at a time (6-4).
struct SystemString {
  static constexpr unsigned kParts = 16;
  std::array<char, 4 * kParts> parts{};  // of the read that goes on
  std::uint32_t have = 0;                // bit n: Index n was read
  std::array<char, 4 * kParts> text{};   // of the last read that came to its end
  std::size_t length = 0;
  std::uint64_t frame = 0;  // that completed it; 0: none did
  std::string_view view() const { return {text.data(), length}; }
};

// A place for each non-cyclic command but the standard one, in the order of kNonCyclicNames.
using CommandDurations = std::array<Durations, std::size(kNonCyclicNames) - 1>;

struct Node {
  std::uint8_t place = 0;
  bool wide = false;
  NodeRef ref;
  OwnerId owner{};
  std::array<ChannelState, 2> channels;  // main, sub
  Knowledge known;
  BlockFormat format;
  const RtexAxisSettings* settings = nullptr;

  // Commands
  bool command_written = false;   // a block that is not all zero was seen
  bool have_command = false;      // `command` is of this run
  bool command_chain = false;     // no gap since `command`
  bool comparable = false;        // and of the record before, without a gap
  CommandView command, previous;  // `previous`: valid where comparable
  BlockWords command_raw = {};
  bool mode_known = false;
  bool mode_commanded = false;  // in this run
  bool servo_on_sent = false;   // the last Servo_On outside NOP
  bool servo_on_known = false;
  std::uint8_t mode = 0;         // the last cyclic code 1 to 4
  std::uint8_t mode_before = 0;  // where mode_changed
  bool mode_changed = false;     // in the record being judged
  bool mode_changed_before = false;
  std::int64_t mode_change_cycle = 0;
  std::uint64_t mode_change_frame = 0;
  std::uint64_t command_frame = 0, previous_frame = 0;
  Quiet quiet;

  // Responses
  bool response_written = false;
  bool have_response = false;        // `response` is of this run
  bool response_chain = false;       // no gap since `response`
  bool response_comparable = false;  // and of the cycle before, without a gap
  ResponseView response, previous_response;
  BlockWords response_raw = {};
  std::uint64_t response_frame = 0;
  std::int64_t response_cycle = 0;
  bool answered = false;  // C/R = 1 seen in this run
  bool mac_known = false;
  bool mac_judged = false;  // RX102: a command was compared with the Actual MAC-ID
  std::uint8_t actual_mac = 0;
  bool synchronised = false;
  bool ignore_stale = false;               // the block of before a reset is still in the memory
  bool status_undefined = false;           // an attribute C validation is Busy
  std::uint32_t communication_errors = 0;  // consecutive
  std::uint32_t same_responses = 0;        // byte for byte, in a row, while the counter moved
  bool counter_moved_since_response = false;
  bool identical_response = false;  // the block is byte for byte the one of the cycle before
  bool zero_response = false;

  Moment limited_since;  // Torque_Limited
  Moment home_cleared;   // the last record of a command that clears Homing_Complete
  std::int64_t servo_change_cycle = 0;
  CounterState counter;
  ProfileState profile;
  LatchState latch;
  Following following;
  InhibitWatch inhibit;
  OffWatch off;
  ProfileWatch profile_watch;
  EmergencyInput emergency;
  std::uint64_t multi_turn_frame = 0;  // RX520: a completed 31h, and the control power was not off since
  Hourly eeprom_writes{-1};
  AlarmState alarms;
  SmallVector<Judged, 16> judged;  // the latest faults of master and network, for causes
  std::array<SystemString, kSystemIdCount> strings;
  CommandDurations echo_times, done_times;

  ChannelState& main() { return channels[0]; }
  ChannelState& sub() { return channels[1]; }
  const ChannelState& main() const { return channels[0]; }
};

struct Learnt {
  std::int64_t value = 0;
  Basis basis;
  explicit operator bool() const { return basis.kind != BasisKind::kNone; }
};

// TMG_CNT of the ring (4-2-1-1): its value is that of most axes.
struct TimingCount {
  bool value = false;
  bool known = false;        // there is a value to compare with
  bool in_phase = false;     // `toggled` is a toggle, not the first record
  std::int64_t toggled = 0;  // the cycle of the last toggle, or of the toggle that did not come
  std::uint64_t toggle_frame = 0;
  std::uint32_t good = 0, bad = 0;  // toggles in a row, irregularities since the last of them
  // Of the record being judged
  enum class Verdict : std::uint8_t { kNone, kInTime, kEarly, kLate } verdict = Verdict::kNone;
  std::int64_t passed = 0;      // cycles since the last toggle
  std::uint32_t differing = 0;  // bit n: the node at place n differs from most
  bool any_set = false;         // in a command other than NOP
  bool is_used = false;         // in full-synchronous mode
  bool semi_decided = false;    // it is set and does not toggle every 2 ms
};

struct Ring {
  Ring(const Settings& given, const BusRef& bus_ref, Findings& list);

  const Settings& settings;
  BusRef bus;
  Findings& findings;
  OwnerId owner{};          // the whole ring
  OwnerId capture_owner{};  // the capture: CP103

  // The last record's header
  bool have_header = false;
  std::uint8_t node_count = 0;
  std::uint32_t wide_nodes = 0;
  std::uint32_t header_cycle_ns = 0;
  bool sampled = false;
  bool timed = false;  // the last record had a time

  // Records
  bool sequence_known = false;
  bool gap_reported = false;   // records were lost, and somebody said so
  std::uint32_t sequence = 0;  // of the cycle at hand
  std::int64_t cycle = 0;      // counts communication cycles; jumps with the sequence
  bool cycle_has_command = false, cycle_has_response = false;
  std::uint32_t missing_responses = 0;
  std::uint64_t missing_from = 0;     // the command of the first of them
  Moment last_command;                // record
  bool last_command_follows = false;  // no gap between the last command record and the one before it
  std::uint64_t last_response_frame = 0;
  TimeNs last_response_time_ns = 0;
  bool shared_carrier = false;  // Ethernet or UDP: the time is the recorder's
  std::uint32_t time_resolution_ns = 1;

  bool running = false;
  bool had_run = false;
  bool ever_lost = false;  // RX115: the ring was lost with a servo on, and is not settled
  std::uint64_t lost_frame = 0;
  bool timeout_pending = false;  // RX112 over Ethernet or UDP: 32 records decide
  std::uint32_t timeout_records = 0;
  Moment timeout_from, timeout_at;
  DurationNs timeout_interval_ns = 0;

  // Learnt
  Learnt cycle_ns;
  Learnt ratio;
  Learnt full_sync;
  bool pair_is_bad = false;  // RX210
  bool pair_judged = false;
  std::uint32_t ratio_records = 0;
  bool ratio_decided = false;
  bool lag_decided = false;
  std::int32_t lag = -1;  // -1: none
  std::uint64_t lag_frame = 0;
  std::uint32_t lag_records = 0;
  std::array<std::uint32_t, 4> lag_mismatches = {};
  std::uint32_t lag_blocks = 0;
  std::uint32_t intervals = 0;
  TimeNs first_interval_time = 0;

  TimingCount timing;

  SmallVector<Judged, 16> judged;  // the latest faults of the whole ring
  std::array<std::unique_ptr<Node>, kMaxNodes> nodes;
  Durations cycle_times;
  Durations cycle_deviations;  // each interval against the communication cycle, once that is known

  struct OfRecord {
    unsigned awake = 0;     // blocks judged in full
    unsigned telling = 0;   // of them, those with more news than of a monitor command: the ring's rules look at them
    bool restless = false;  // a word that moves an axis or is measured is another one, or a quiet block raised
  } of_record;
  bool record_quiet = false;  // the rules of the last command record passed, and no block has told anything since
  bool record_raised = false;
  PassedRows record_passed;

  // Software reset (6-3-1)
  bool reset_sent = false;      // in this record a node went back from an echoed reset command
  bool reset_reported = false;  // RX601, once a reset
  bool last_all_nop = false;    // the command record before was NOP for every node
  bool awaiting_start = false;  // after a reset: what the memories hold is old until the ring starts again

  Node& node(unsigned place) {
    Node* const known = nodes[place].get();
    return known != nullptr ? *known : make_node(place);
  }
  Node& make_node(unsigned place);
  std::span<const std::unique_ptr<Node>> all() const { return std::span(nodes).first(node_count); }
};

}  // namespace servotrace::rtex
