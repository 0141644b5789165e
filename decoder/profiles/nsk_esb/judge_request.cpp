// SPDX-License-Identifier: MIT
// The parameter handshake and what is asked for by it: NK101-NK112, NK201-NK205; and what it teaches.
#include "decoder/findings/catalogue.hpp"
#include "decoder/profiles/nsk_esb/derived.hpp"
#include "decoder/profiles/nsk_esb/session.hpp"

namespace servotrace::esb {
namespace {

constexpr std::int64_t kFirstParameter = 1;
constexpr std::int64_t kLastParameter = 299;

ByteRange request_bytes(const Message& message) { return bytes_in_frame(message, 3, 7); }
ByteRange control_byte(const Message& message) { return bytes_in_frame(message, 3, 1); }

bool is_long(std::int64_t number) {
  return (number >= 300 && number <= 302) || number == kInitialize || number == kWriteData;
}

}  // namespace

DurationNs Session::limit_ns(std::int64_t number) const {
  return milliseconds(is_long(number) ? limits().prm_ack_long_ms : limits().prm_ack_ms);
}

void Session::step_handshake(const Context& context, const Message& message, HandshakeEvent event) {
  const auto& row = kHandshake.next(handshake_, event);
  const std::uint64_t answer_frame = output_ ? output_->frame : 0;
  handshake_ = row.to;
  switch (row.action) {
    case HandshakeAction::kBegin:
      checked(context, rule("NK101"));
      break;
    case HandshakeAction::kRestart:
      checked(context, rule("NK101"));
      raise(context, {.rule = rule("NK101"), .where = control_byte(message), .related = {answer_frame}});
      transaction_.begun = false;
      break;
    case HandshakeAction::kDrop:
      checked(context, rule("NK102"));
      raise(context, {.rule = rule("NK102"),
                      .arguments = {transaction_.number},
                      .where = control_byte(message),
                      .related = {transaction_.frame, answer_frame}});
      transaction_ = {};
      break;
    case HandshakeAction::kChange:
      checked(context, rule("NK103"));
      raise(context, {.rule = rule("NK103"),
                      .arguments = {transaction_.number},
                      .where = request_bytes(message),
                      .related = {transaction_.frame, answer_frame}});
      break;
    case HandshakeAction::kMissing:
      if (!transaction_.begun || !transaction_.answered_once || transaction_.missing_found) break;
      transaction_.missing_found = true;
      raise(context, {.rule = rule("NK104"),
                      .arguments = {transaction_.number, elapsed_ns(transaction_.time_ns, context.frame.time_ns)},
                      .where = message.in_frame,
                      .related = {transaction_.frame}});
      break;
    case HandshakeAction::kStuck:
      if (!release_seen_) break;
      release_seen_ = false;
      raise(context, {.rule = rule("NK105"),
                      .arguments = {elapsed_ns(release_ns_, context.frame.time_ns)},
                      .where = control_byte(message),
                      .related = {release_frame_}});
      break;
    case HandshakeAction::kRelease:
      checked(context, rule("NK102"));
      release_seen_ = true;
      release_frame_ = context.frame.number;
      release_ns_ = context.frame.time_ns;
      break;
    case HandshakeAction::kFinish:
      checked(context, rule("NK105"));
      if (release_seen_) releases_.add(elapsed_ns(release_ns_, context.frame.time_ns));
      release_seen_ = false;
      break;
    case HandshakeAction::kResult:
    case HandshakeAction::kNone:
    case HandshakeAction::kUnrequested:
      break;
  }
}

// PRM_REQ rises: what it asks for is judged now, the answer when it comes.
void Session::begin_request(const Context& context, const Message& message, const Input& input) {
  transaction_ = {.begun = true,
                  .frame = context.frame.number,
                  .time_ns = context.frame.time_ns,
                  .write = input.prm_ope,
                  .number = input.number,
                  .data = input.data,
                  .changed_number = input.number};
  show_transaction(context, nullptr);
  judge_number(context, message, input);
}

void Session::judge_number(const Context& context, const Message& message, const Input& input) {
  const ByteRange where = request_bytes(message);
  const std::int64_t number = input.number;
  const Number* row = find_number(number);
  for (const RuleId id : {rule("NK108"), rule("NK110"), rule("NK111")}) checked(context, id);
  if (row == nullptr) {
    raise(context, {.rule = rule("NK108"), .arguments = {number}, .where = where});
    return;
  }
  if (input.prm_ope ? !row->is_writable() : !row->is_readable()) {
    raise(context, {.rule = rule("NK110"), .arguments = {number, input.prm_ope ? 1 : 0}, .where = where});
    return;
  }
  if (number == kDigitalCommand || (number == kControlMode && (input.data == 1 || input.data == 2) && input.prm_ope)) {
    raise(context, {.rule = rule("NK111"), .arguments = {number, input.data}, .where = where});
    return;
  }
  if (input.prm_ope && row->has_data) {
    checked(context, rule("NK109"));
    if (!row->allows(input.data)) {
      raise(context, {.rule = rule("NK109"),
                      .arguments = {number, input.data},
                      .where = bytes_in_frame(message, kDataOffset, 4),
                      .as_note = number == 82});
    }
  }
  judge_program_session(context, message, input);
}

// NK201-NK205: what may be asked for while a program is edited or read out. Unknown until something shows it.
void Session::judge_program_session(const Context& context, const Message& message, const Input& input) {
  const std::int64_t number = input.number;
  const ByteRange where = request_bytes(message);
  const std::array<std::uint64_t, 2> related = {session_frame_, 0};
  const bool command = is_program_command(number);
  const bool option = is_optional_code(number);
  switch (program_session_) {
    case ProgramSession::kUnknown:
      return;
    case ProgramSession::kNone:
      checked(context, rule("NK201"));
      checked(context, rule("NK204"));
      if (command || option) raise(context, {.rule = rule("NK201"), .arguments = {number}, .where = where});
      if (number == kReadProgram) raise(context, {.rule = rule("NK204"), .where = where});
      return;
    case ProgramSession::kEdit:
      checked(context, rule("NK202"));
      if (!command && !option && number != kEndSession) {
        raise(context,
              {.rule = rule("NK202"), .arguments = {number, session_channel_}, .where = where, .related = related});
      }
      if (option) {
        checked(context, rule("NK203"));
        if (!option_allowed(session_command_, number)) {
          raise(context, {.rule = rule("NK203"), .arguments = {number, session_command_}, .where = where});
        }
      }
      if (command) session_command_ = input.number;
      return;
    case ProgramSession::kRead:
      checked(context, rule("NK205"));
      if (number != kReadProgram && number != kEndSession) {
        raise(context,
              {.rule = rule("NK205"), .arguments = {number, session_channel_}, .where = where, .related = related});
      }
      return;
  }
}

// PRM_ACK rises for a request.
void Session::take_result(const Context& context, const Message& message, const Output& output) {
  const ByteRange where = bytes_in_frame(message, 3, 3);
  checked(context, rule("NK104"));
  checked(context, rule("NK106"));
  if (transaction_.begun) {
    link(context, LinkKind::kRequestIn, transaction_.frame, transaction_.time_ns);
    const DurationNs took_ns = elapsed_ns(transaction_.time_ns, context.frame.time_ns);
    (transaction_.write ? writes_ : reads_).add(took_ns);
    add(context, kTransactionTime, "esb", took_ns);
    show_transaction(context, &output);
  }
  const std::int64_t number = transaction_.begun ? transaction_.number : output.number;
  if (!output.prm_sts) {
    const std::uint64_t since = transaction_.begun ? transaction_.frame : context.frame.number;
    raise(context, {.rule = rule("NK106"),
                    .arguments = {number, transaction_.data, transaction_.write ? 1 : 0},
                    .where = where,
                    .related = {transaction_.frame},
                    .cause = cause_among(context,
                                         {rule("NK108"), rule("NK109"), rule("NK110"), rule("NK111"), rule("NK201"),
                                          rule("NK202"), rule("NK203"), rule("NK204"), rule("NK205"), rule("NK301"),
                                          rule("NK302"), rule("NK303"), rule("NK304"), rule("NK103"), rule("NK101")},
                                         since)});
    return;
  }
  if (!transaction_.begun) return;
  checked(context, rule("NK107"));
  if (number != kReadProgram && output.number != number && output.number != transaction_.changed_number) {
    raise(context, {.rule = rule("NK107"),
                    .arguments = {number, output.number},
                    .where = bytes_in_frame(message, 4, 2),
                    .related = {transaction_.frame}});
    return;
  }
  if (transaction_.changed_number != transaction_.number) return;  // which of the two was done is not known
  learn(context, output);
  if (transaction_.write && ((number >= kFirstParameter && number <= kLastParameter) || number == kWriteData)) {
    count_flash_write(context, message);
  }
}

// A successful transaction teaches what it wrote or read.
void Session::learn(const Context& context, const Output& output) {
  const std::int64_t number = transaction_.number;
  if (number >= kFirstParameter && number <= kLastParameter) {
    known_[static_cast<std::size_t>(number)] = {true, true, transaction_.write ? transaction_.data : output.data,
                                                context.frame.number};
    if (transaction_.write && number == kDirectionInversion) {
      inversion_frame_ = context.frame.number;
      inversion_ns_ = context.frame.time_ns;
    }
  }
  if (number == kInitialize) known_ = {};
  if (number == kAlarmWordNumber && !transaction_.write) {
    const std::int64_t word = static_cast<std::uint32_t>(output.data);
    if (not_ready_.active) issue_not_ready(context, word);
    if (warning_.active) issue_warning(context, word);
  }
  learn_program(context, output);
}

void Session::learn_program(const Context& context, const Output& output) {
  const std::int64_t number = transaction_.number;
  Channel& channel = programs_.channel(session_channel_);
  switch (number) {
    case kEditChannel:
    case kTellChannel:
      program_session_ = number == kEditChannel ? ProgramSession::kEdit : ProgramSession::kRead;
      session_channel_ = static_cast<std::uint8_t>(transaction_.data & 0x3F);
      session_frame_ = transaction_.frame;
      session_command_ = 0;
      edit_begins_ = number == kEditChannel;
      if (number == kTellChannel) programs_.channel(session_channel_) = {};
      return;
    case kEndSession:
      if (program_session_ == ProgramSession::kEdit && channel.known) show_listing(context, session_channel_);
      program_session_ = ProgramSession::kNone;
      return;
    case kClearChannel: {
      Channel& cleared = programs_.channel(static_cast<std::uint8_t>(transaction_.data & 0x3F));
      cleared = {};
      cleared.known = true;
      cleared.frame = context.frame.number;
      break;
    }
    case kReadProgram:
      if (program_session_ != ProgramSession::kRead) return;
      channel.frame = context.frame.number;
      if (output.number == kEndOfProgram) {
        channel.known = channel.steps.dropped() == 0;
      } else {
        channel.steps.push_back({output.number, output.data});
      }
      show_listing(context, session_channel_);
      return;
    default:
      if (is_program_command(number) || is_optional_code(number)) {
        if (program_session_ != ProgramSession::kEdit) return;
        // The first command of an edit begins the program anew; more of them add lines.
        if (is_program_command(number) && edit_begins_) {
          edit_begins_ = false;
          channel.steps.clear();
          channel.known = true;
          channel.doubted = false;
        }
        Programs::write(channel, {transaction_.number, transaction_.data});
        if (channel.steps.dropped() != 0) channel.known = false;
        channel.frame = context.frame.number;
        show_listing(context, session_channel_);
        return;
      }
      break;
  }
  // Any other number is taken only while no program is edited or read out.
  program_session_ = ProgramSession::kNone;
}

// NK112: writes that go to the EEPROM, by the hour.
void Session::count_flash_write(const Context& context, const Message& message) {
  const std::int32_t* mode = known_value(kWriteMode);
  const bool backed_up = transaction_.number == kWriteData || mode == nullptr || *mode == 0;
  if (!backed_up) return;
  const bool often = flash_writes_.add(context.frame.time_ns);
  judge(context, often,
        {.rule = rule("NK112"),
         .arguments = {limits().flash_writes_per_hour},
         .where = message.in_frame,
         .basis = mode != nullptr ? basis_of(kWriteMode) : Basis{BasisKind::kAssumed, 0}});
}

// "write VG45.0", with the answer "write VG45.0: successful" or "read PG: 0.400".
void Session::show_transaction(const Context& context, const Output* output) {
  if (context.dissection == nullptr) return;
  text_.clear();
  const Number* row = find_number(transaction_.number);
  text_ << (transaction_.write ? "write " : "read ");
  if (transaction_.write) {
    append_step(text_, transaction_.number, transaction_.data);
  } else if (row == nullptr) {
    text_ << std::int64_t{transaction_.number};
  } else {
    text_ << (row->mnemonic.empty() ? row->name : row->mnemonic);
  }
  if (output != nullptr) {
    text_ << ": ";
    if (!output->prm_sts) {
      text_ << "failed";
    } else if (transaction_.write) {
      text_ << "successful";
    } else if (transaction_.number == kReadProgram) {
      if (output->number == kEndOfProgram) {
        text_ << "end of the program";
      } else {
        append_step(text_, output->number, output->data);
      }
    } else {
      text_.decimal(output->data, row == nullptr ? 0U : row->decimals);
    }
  }
  add(context, kTransaction, "esb", 0, text_.view());
}

void Session::show_listing(const Context& context, std::uint8_t channel) {
  if (context.dissection == nullptr) return;
  listing_.clear();
  append_listing(listing_, channel, programs_.channel(channel));
  add(context, kListing, "esb", 0, listing_.view());
}

}  // namespace servotrace::esb
