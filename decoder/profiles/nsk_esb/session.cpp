// SPDX-License-Identifier: MIT
#include "decoder/profiles/nsk_esb/session.hpp"

#include "decoder/findings/catalogue.hpp"
#include "decoder/profiles/nsk_esb/profile.hpp"

namespace servotrace::esb {

// What is shown of both ends once both are seen.
void Session::settle_handshake() {
  if (handshake_ != Handshake::kUnknown || !input_ || !output_) return;
  handshake_ = handshake_of(input_->prm_req, output_->prm_ack);
  waits_ = true;
}

// The input before once more: nothing rises or falls. False, and nothing was done, where it is to be judged.
bool Session::repeats_command(const Context& context, const Image& image) {
  if (!input_ || image != input_image_ || input_->reserved || context.dissection != nullptr ||
      context.settings.judge_every_block) {
    return false;
  }
  expire(context);
  passed(context, rule("NK308"));
  input_->frame = context.frame.number;
  input_->time_ns = context.frame.time_ns;
  settle_handshake();
  return true;
}

// The output before once more: no report is new. False, and nothing was done, where it is to be judged.
bool Session::repeats_response(const Context& context, const Message& message, const Image& image) {
  if (!output_ || image != output_image_ || !reported_.known || context.dissection != nullptr ||
      context.settings.judge_every_block) {
    return false;
  }
  transaction_.answered_once = true;
  for (const RuleId id : {rule("NK901"), rule("NK902"), rule("NK903"), rule("NK904"), rule("NK905")}) {
    checked(context, id);
  }
  output_->frame = context.frame.number;
  output_->time_ns = context.frame.time_ns;
  await_busy(context, message, *output_);
  if (!output_->busy) runs_ = Runs::kUnknown;
  expire(context);
  settle_handshake();
  return true;
}

void Session::on_command(const Context& context, const Message& message) {
  if (message.bytes.size() < kMessageSize) return;
  const Image image = Image::of(message.bytes);
  if (repeats_command(context, image)) return;
  input_image_ = image;
  waits_ = true;
  add(context, message, kInput, 0, Direction::kCommand, kMessageSize);
  const Input input = read_input(message.bytes, context.frame.number, context.frame.time_ns);
  if (input.prm_req && input.prm_ope) {
    if (const Layout* layout = data_layout(input.number)) {
      add(context, message, *layout, kDataOffset, Direction::kCommand);
    }
  }
  expire(context);
  judge_motion(context, message, input);
  if (input_) {
    if (!input_->prm_req && input.prm_req) {
      transaction_ = {};
      if (output_) begin_request(context, message, input);
      step_handshake(context, message, HandshakeEvent::kRequestRises);
    } else if (input_->prm_req && !input.prm_req) {
      step_handshake(context, message, HandshakeEvent::kRequestFalls);
    } else if (input.prm_req && (input_->prm_ope != input.prm_ope || input_->number != input.number ||
                                 (input_->prm_ope && input_->data != input.data))) {
      transaction_.changed_number = input.number;
      step_handshake(context, message, HandshakeEvent::kRequestChanges);
    }
  }
  input_ = input;
  settle_handshake();
}

void Session::on_response(const Context& context, const Message& message) {
  if (message.bytes.size() < kMessageSize) return;
  const Image image = Image::of(message.bytes);
  if (repeats_response(context, message, image)) return;
  output_image_ = image;
  waits_ = true;
  add(context, message, kOutput, 0, Direction::kResponse, kMessageSize);
  const Output output = read_output(message.bytes, context.frame.number, context.frame.time_ns);
  if (output.prm_ack && output.prm_sts) {
    if (const Layout* layout = data_layout(output.number)) {
      add(context, message, *layout, kDataOffset, Direction::kResponse);
    }
  }
  transaction_.answered_once = true;
  const bool rises = output_ && !output_->prm_ack && output.prm_ack;
  const bool falls = output_ && output_->prm_ack && !output.prm_ack;
  if (rises && handshake_ == Handshake::kRequested) take_result(context, message, output);
  judge_reports(context, message, output);
  await_busy(context, message, output);
  if (!output.busy) runs_ = Runs::kUnknown;
  output_ = output;
  if (rises) step_handshake(context, message, HandshakeEvent::kConfirmRises);
  if (falls) step_handshake(context, message, HandshakeEvent::kConfirmFalls);
  expire(context);
  settle_handshake();
}

void Session::on_explicit(const Context& context, const ExplicitExchange&) { expire(context); }

void Session::on_time(const Context& context) {
  expire(context);
  waits_ =
      not_ready_.active || warning_.active || handshake_ == Handshake::kRequested || handshake_ == Handshake::kReleased;
}

void Session::on_start(const Context&) {
  on_gap();
  reported_.known = false;
  start_seen_ = true;
  // What is in its EEPROM is not known: a parameter may have been written without backup (WM).
  known_ = {};
  programs_.forget();
  program_session_ = ProgramSession::kNone;
}

void Session::on_gap() {
  input_.reset();
  output_.reset();
  handshake_ = Handshake::kUnknown;
  transaction_ = {};
  release_seen_ = false;
  program_session_ = ProgramSession::kUnknown;
  runs_ = Runs::kUnknown;
  busy_awaited_ = false;
  // A write may be among what was lost: what is shown stays, what is judged is not known any more.
  for (Known& entry : known_) entry.certain = false;
  programs_.doubt();
}

void Session::on_finish(const Context& context) {
  if (not_ready_.active) issue_not_ready(context, -1);
  if (warning_.active) issue_warning(context, -1);
  if (program_session_ == ProgramSession::kEdit || program_session_ == ProgramSession::kRead) {
    raise(context, {.rule = rule("NK206"),
                    .arguments = {program_session_ == ProgramSession::kEdit ? 0 : 1, session_channel_, 1},
                    .related = {session_frame_},
                    .as_note = true});
  }
}

void Session::summarise(NodeSummary& summary, std::vector<Statistic>& statistics) const {
  for (std::size_t number = 0; number < known_.size(); ++number) {
    if (!known_[number].known) continue;
    const Number* row = find_number(static_cast<std::int64_t>(number));
    if (row == nullptr) continue;
    Text<32> value;
    value.decimal(known_[number].value, row->decimals);
    summary.facts.push_back(
        {std::string(row->mnemonic), std::string(value.view()), {BasisKind::kCapture, known_[number].frame}});
  }
  for (std::size_t number = 0; number < kChannels; ++number) {
    const auto channel = static_cast<std::uint8_t>(number);
    if (!programs_.channel(channel).known) continue;
    Listing listing;
    append_listing(listing, channel, programs_.channel(channel));
    const std::string_view text = listing.view();
    const std::size_t colon = text.find(": ");
    summary.facts.push_back({std::string(text.substr(0, colon)),
                             std::string(text.substr(colon + 2)),
                             {BasisKind::kCapture, programs_.channel(channel).frame}});
  }
  append_statistic(statistics, "parameter read", node(), reads_);
  append_statistic(statistics, "parameter write", node(), writes_);
  append_statistic(statistics, "PRM_ACK release", node(), releases_);
  append_statistic(statistics, "RUN to BUSY", node(), start_to_busy_);
}

const DriveProfile& Profile::row() { return kProfile; }

std::unique_ptr<DriveSession> make_session(const Settings& settings, const NodeRef& node, OwnerId owner,
                                           bool decode_only) {
  return std::make_unique<Session>(settings, node, owner, decode_only);
}

}  // namespace servotrace::esb
