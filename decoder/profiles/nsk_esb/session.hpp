// SPDX-License-Identifier: MIT
// What is known of one ESB, and the judging of its traffic (ESB 4.3 to 5.4, 7.1). The drive's state is its last whole
// output before the input at hand; until there is one, a rule that needs it is silent.
#pragma once

#include <optional>

#include "decoder/core/durations.hpp"
#include "decoder/core/hourly.hpp"
#include "decoder/profiles/drive_base.hpp"
#include "decoder/profiles/nsk_esb/alarms.hpp"
#include "decoder/profiles/nsk_esb/assemblies.hpp"
#include "decoder/profiles/nsk_esb/handshake.hpp"
#include "decoder/profiles/nsk_esb/programs.hpp"

namespace servotrace::esb {

// Numbers of the command list that rules know by name.
inline constexpr std::int64_t kDirectionInversion = 101;  // DI
inline constexpr std::int64_t kOverrideRatio = 131;       // OV
inline constexpr std::int64_t kProgramHome = 141;         // PH
inline constexpr std::int64_t kWriteMode = 200;           // WM
inline constexpr std::int64_t kControlMode = 240;         // SL
inline constexpr std::int64_t kInitialize = 320;          // SI
inline constexpr std::int64_t kWriteData = 321;           // WD
inline constexpr std::int64_t kStartProgram = 412;        // SP
inline constexpr std::int64_t kHomeReturn = 420;          // HS
inline constexpr std::int64_t kDigitalCommand = 440;      // DC
inline constexpr std::int64_t kEditChannel = 500;         // CH
inline constexpr std::int64_t kTellChannel = 501;         // TC
inline constexpr std::int64_t kEndSession = 502;
inline constexpr std::int64_t kClearChannel = 503;     // CC
inline constexpr std::int64_t kAlarmWordNumber = 800;  // TA
inline constexpr std::int64_t kReadProgram = 820;
inline constexpr std::int64_t kEndOfProgram = -1;

constexpr bool is_motion_command(std::int64_t number) {
  return (number >= 400 && number <= kStartProgram) || number == kHomeReturn;
}

// What started a motion: the argument of rules.
enum class StartKind : std::uint8_t { kRun, kHos, kJog, kCommand };

class Session final : public DriveBase {
 public:
  Session(const Settings& settings, const NodeRef& node, OwnerId owner, bool decode_only)
      : DriveBase(settings, node, owner, decode_only), flash_writes_(settings.limits.flash_writes_per_hour) {}

  void on_command(const Context& context, const Message& message) override;
  void on_response(const Context& context, const Message& message) override;
  void on_explicit(const Context& context, const ExplicitExchange& exchange) override;
  void on_time(const Context& context) override;
  void on_start(const Context& context) override;
  void on_gap() override;
  void on_finish(const Context& context) override;
  bool is_moving() const override { return output_ && output_->busy; }
  void summarise(NodeSummary& summary, std::vector<Statistic>& statistics) const override;

 private:
  // A parameter transaction, from PRM_REQ = 1 to its answer.
  struct Transaction {
    bool begun = false;  // its start was seen
    std::uint64_t frame = 0;
    TimeNs time_ns = 0;
    bool write = false;
    std::int16_t number = 0;
    std::int32_t data = 0;
    std::int16_t changed_number = 0;  // the last one, where NK103 changed it
    bool answered_once = false;       // an output was seen since
    bool missing_found = false;       // NK104
  };
  enum class ProgramSession : std::uint8_t { kUnknown, kNone, kEdit, kRead };
  // What moves, by the last start the drive could accept.
  enum class Runs : std::uint8_t { kUnknown, kProgram, kOther };
  struct Known {
    bool known = false;
    bool certain = false;  // and no record was lost since
    std::int32_t value = 0;
    std::uint64_t frame = 0;
  };
  struct PendingReport {
    bool active = false;
    std::uint64_t frame = 0;
    TimeNs since_ns = 0;
    std::uint8_t outputs = 0;  // pattern()
    bool brake_counts = true;
    Phase phase = Phase::kRises;
    Cause cause;
  };
  // What the drive reported last; kept across gaps, for a gap does not hide a rise.
  struct Reported {
    bool known = false;
    bool drdy = false;
    bool over = false;
    bool emsta = false;
    bool otpa = false;
    bool otma = false;
    bool hcmp = false;
  };

  // The bytes of a message, for comparing it with the one before.
  struct Image {
    std::uint64_t head = 0;
    std::uint32_t tail = 0;
    bool operator==(const Image&) const = default;
    // Precondition: kMessageSize bytes.
    static Image of(Bytes bytes) { return {load_le64(bytes, 0), load_le(bytes, 8, 2)}; }
  };
  static_assert(kMessageSize == 10);
  void settle_handshake();
  bool repeats_command(const Context& context, const Image& image);
  bool repeats_response(const Context& context, const Message& message, const Image& image);

  // judge_request.cpp
  void step_handshake(const Context& context, const Message& message, HandshakeEvent event);
  void begin_request(const Context& context, const Message& message, const Input& input);
  void judge_number(const Context& context, const Message& message, const Input& input);
  void judge_program_session(const Context& context, const Message& message, const Input& input);
  void take_result(const Context& context, const Message& message, const Output& output);
  void learn(const Context& context, const Output& output);
  void learn_program(const Context& context, const Output& output);
  void count_flash_write(const Context& context, const Message& message);
  DurationNs limit_ns(std::int64_t number) const;
  void show_transaction(const Context& context, const Output* output);
  void show_listing(const Context& context, std::uint8_t channel);

  // judge_motion.cpp
  void judge_motion(const Context& context, const Message& message, const Input& input);
  void judge_start(const Context& context, const Message& message, const Input& input, StartKind kind);
  void judge_home(const Context& context, const Message& message, const Input& input, StartKind kind);
  void await_busy(const Context& context, const Message& message, const Output& output);

  // judge_output.cpp
  void judge_reports(const Context& context, const Message& message, const Output& output);
  void issue_not_ready(const Context& context, std::int64_t word);
  void issue_warning(const Context& context, std::int64_t word);
  void expire(const Context& context);
  std::uint64_t fitting(const PendingReport& report, std::int64_t word) const;

  const std::int32_t* known_value(std::int64_t number) const {
    return number >= 0 && number < std::int64_t{kKnownNumbers} && known_[static_cast<std::size_t>(number)].certain
               ? &known_[static_cast<std::size_t>(number)].value
               : nullptr;
  }
  Basis basis_of(std::int64_t number) const {
    return {BasisKind::kCapture, known_[static_cast<std::size_t>(number)].frame};
  }

  static constexpr std::size_t kKnownNumbers = 300;  // parameters are 1 to 299

  std::optional<Input> input_;        // the last one; empty at the start and after a gap
  std::optional<Output> output_;      // likewise
  Image input_image_, output_image_;  // theirs
  Reported reported_;
  bool start_seen_ = false;

  Handshake handshake_ = Handshake::kUnknown;
  Transaction transaction_;
  std::uint64_t release_frame_ = 0;  // PRM_REQ = 0 after the answer, seen
  TimeNs release_ns_ = 0;
  bool release_seen_ = false;

  std::array<Known, kKnownNumbers> known_{};
  Programs programs_;
  ProgramSession program_session_ = ProgramSession::kUnknown;
  std::uint8_t session_channel_ = 0;
  std::uint64_t session_frame_ = 0;
  bool edit_begins_ = false;          // no program command was taken in this edit yet
  std::int16_t session_command_ = 0;  // the last program command asked for in this edit; 0: none

  Runs runs_ = Runs::kUnknown;
  bool busy_awaited_ = false;  // NK305
  std::uint64_t run_frame_ = 0;
  TimeNs run_ns_ = 0;

  PendingReport not_ready_;
  PendingReport warning_;
  std::uint64_t inversion_frame_ = 0;  // DI was written (NK905)
  TimeNs inversion_ns_ = 0;

  Hourly flash_writes_;

  Durations reads_;
  Durations writes_;
  Durations releases_;
  Durations start_to_busy_;
  Listing text_;     // of the derived fields; valid as long as the dissection
  Listing listing_;  // likewise
};

}  // namespace servotrace::esb
