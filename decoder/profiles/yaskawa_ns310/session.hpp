// SPDX-License-Identifier: MIT
// What is known of one NS310, and the judging of its traffic (SIE-C718-7 5.3 to 5.6). The drive's state is its last
// whole response before the command; until there is one, a rule that needs it is silent.
#pragma once

#include <optional>

#include "decoder/core/durations.hpp"
#include "decoder/core/hourly.hpp"
#include "decoder/profiles/drive_base.hpp"
#include "decoder/profiles/yaskawa_ns310/assemblies.hpp"
#include "decoder/profiles/yaskawa_ns310/blocks.hpp"
#include "decoder/profiles/yaskawa_ns310/rule_names.hpp"

namespace servotrace::ns310 {

class Session final : public DriveBase {
 public:
  Session(const Settings& settings, const NodeRef& node, OwnerId owner, bool decode_only)
      : DriveBase(settings, node, owner, decode_only), flash_starts_(settings.limits.flash_writes_per_hour) {}

  void on_command(const Context& context, const Message& message) override;
  void on_response(const Context& context, const Message& message) override;
  void on_explicit(const Context& context, const ExplicitExchange& exchange) override;
  void on_time(const Context& context) override;
  void on_start(const Context& context) override;
  void on_gap() override;
  void on_finish(const Context& context) override;
  bool is_moving() const override { return response_ && response_->in_progress; }
  void summarise(NodeSummary& summary, std::vector<Statistic>& statistics) const override;

 private:
  // Something that must have happened after some answered polls and some time.
  struct Wait {
    bool active = false;
    std::uint64_t frame = 0;
    TimeNs since_ns = 0;
    std::int64_t polls = 0;
    void begin(std::uint64_t at_frame, TimeNs time_ns) { *this = {true, at_frame, time_ns, 0}; }
    void end() { active = false; }
  };
  // A report of the drive that waits for its code.
  struct PendingReport {
    bool active = false;
    std::uint64_t frame = 0;
    TimeNs since_ns = 0;
    Phase phase = Phase::kRises;
    Cause cause;
  };
  // A setting that decides a rule, and what shows it.
  struct Setting {
    std::int64_t value = 0;
    Basis basis = {BasisKind::kAssumed, 0};
    bool certain = true;  // no record was lost since
    bool is_known() const { return basis.kind == BasisKind::kCapture && certain; }
  };
  // What the drive reported last; kept across gaps, for a gap does not hide a rise.
  struct Reported {
    bool known = false;
    bool alarm = false;
    bool command_error = false;
    bool emergency_stop = false;
    bool block_fault = false;
    std::uint8_t limits = 0;  // bit 0 CW, 1 CCW, 2 positive, 3 negative
  };

  void show_alarm(const Context& context, std::int64_t code) const;
  bool repeats_command(const Context& context, std::uint64_t image);
  bool repeats_response(const Context& context, const Message& message, std::uint64_t image);

  // judge_command.cpp
  void judge_data(const Context& context, const Message& message, const Command& command);
  void judge_start(const Context& context, const Message& message, const Command& command);
  void judge_levels(const Context& context, const Message& message, const Command& command);
  void judge_unchanged_start(const Context& context, const Message& message, const Command& command);
  bool into_limit(const Context& context, const Message& message, const Command& command);
  void start_accepted(const Command& command);
  // A finding on the command at hand.
  void fault(const Context& context, const Report& report) {
    raise(context, report);
    command_clean_ = false;
  }
  void fault_while(const Context& context, bool found, const Report& report) {
    judge(context, found, report);
    if (found) command_clean_ = false;
  }
  bool elapsed(const Context& context, const Wait& wait) const {
    return wait.polls >= limits().poll_echo_count &&
           elapsed_ns(wait.since_ns, context.frame.time_ns) >= milliseconds(limits().handshake_ms);
  }

  // judge_explicit.cpp
  void learn_parameter(const Context& context, const ExplicitExchange& exchange, std::int64_t value, bool written);
  void judge_pairs(const Context& context);
  void judge_parameters_at_start(const Context& context, ByteRange where);
  void judge_block_request(const Context& context, const ExplicitExchange& exchange);
  void learn_block(const Context& context, const ExplicitExchange& exchange);
  void show_block(const Context& context, const Message& message, const Block& block, Direction direction) const;
  void show_block_attribute(const Context& context, const ExplicitExchange& exchange, const Block& block, Bytes data);
  void judge_chain(const Context& context, std::uint8_t first, ByteRange where);
  void judge_sequencer_start(const Context& context, const ExplicitExchange& exchange);

  // judge_response.cpp
  void judge_echoes(const Context& context, const Message& message, const Response& response);
  void judge_reports(const Context& context, const Message& message, const Response& response);
  void track_operation(const Response& response);
  void judge_home_travel(const Context& context, const Message& message, const Response& response);
  void issue_alarm(const Context& context, std::int64_t code, ByteRange where);
  void issue_block_fault(const Context& context, std::int64_t code);
  void expire(const Context& context);
  Cause cause_of_refusal(const Context& context) const;

  std::optional<Command> command_;    // the last one; empty at the start and after a gap
  std::optional<Response> response_;  // likewise
  std::uint64_t command_image_ = 0;   // their bytes
  std::uint64_t response_image_ = 0;
  bool command_clean_ = true;  // no finding on the command at hand
  Reported reported_;
  PendingReport pending_alarm_;
  PendingReport pending_block_fault_;
  std::uint64_t refusable_since_ = 0;  // frame of the command before the last response without Command_Error

  Wait valid_wait_;       // Valid_Data = 1 and its echo (YS109)
  Wait start_wait_;       // Start_Trajectory and its echo (YS111)
  Wait edge_wait_;        // changed motion data under a held start (YS116)
  Wait continuous_wait_;  // changed speed that is not taken (YS119)
  bool edge_found_ = false;
  bool continuous_found_ = false;
  bool error_cleared_ = true;        // Valid_Data = 0 was sent since Command_Error rose (YS110)
  std::optional<Command> started_;   // the command at the last rising edge of Start_Trajectory
  std::optional<Command> rotation_;  // the last command whose continuous speed was taken
  Operation operation_ = Operation::kUnknown;
  Operation candidate_ = Operation::kUnknown;  // what the last accepted start sets in motion
  std::optional<std::int32_t> position_;       // steps; while the axis stands still
  Setting written_direction_;                  // 25h/24 as written: in force after a reset
  Setting reference_direction_;                // 25h/24; 0: clockwise is positive
  bool start_seen_ = false;                    // the capture shows the node's start
  bool homed_ = false;                         // a homing was started since

  // A parameter was set that acts after a reset only (YS403).
  struct NeedsReset {
    bool active = false;
    std::uint16_t class_id = 0;
    std::int32_t attribute = 0;
    std::uint64_t frame = 0;
  };
  NeedsReset needs_reset_;
  Setting gear_numerator_;    // 64h/30
  Setting gear_denominator_;  // 64h/31
  Setting acceleration_;      // 64h/56
  Setting filter_;            // 64h/58
  Setting jog_acceleration_;  // 64h/65
  bool settle_pending_ = false;
  TimeNs settle_ns_ = 0;      // the last Set of one of these
  bool flash_dirty_ = false;  // a parameter was set since the last start
  Hourly flash_starts_;
  Blocks blocks_;
  std::optional<std::uint8_t> sequencer_block_;  // 26h/1, where the capture shows it
  std::uint8_t homing_block_ = 0;                // the block 10h that was judged (YS202)
  Text<64> attribute_text_;                      // likewise
  BlockText text_;                               // of the derived fields; valid as long as the dissection

  Durations valid_echo_;
  Durations start_echo_;
};

}  // namespace servotrace::ns310
