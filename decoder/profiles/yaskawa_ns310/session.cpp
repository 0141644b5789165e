// SPDX-License-Identifier: MIT
#include "decoder/profiles/yaskawa_ns310/session.hpp"

#include <string>

#include "decoder/profiles/yaskawa_ns310/profile.hpp"

namespace servotrace::ns310 {

// The command before once more, which nothing was found in and which starts nothing: its levels and codes are as good
// as they were. False, and nothing was done, where it is to be judged.
bool Session::repeats_command(const Context& context, std::uint64_t image) {
  if (!command_ || image != command_image_ || !command_clean_ || command_->start_trajectory ||
      context.dissection != nullptr || context.settings.judge_every_block) {
    return false;
  }
  if (response_ && (response_->command_error || (rotation_ && response_->in_progress))) return false;
  expire(context);
  for (const RuleId id :
       {rule("YS101"), rule("YS102"), rule("YS103"), rule("YS107"), rule("YS108"), rule("YS114"), rule("YS115")}) {
    passed(context, id);
  }
  start_wait_.end();
  edge_wait_.end();
  continuous_wait_.end();
  edge_found_ = continuous_found_ = false;
  if (!command_->valid_data) valid_wait_.end();
  command_->frame = context.frame.number;
  command_->time_ns = context.frame.time_ns;
  return true;
}

// The response before once more: no report is new. False, and nothing was done, where it is to be judged.
bool Session::repeats_response(const Context& context, const Message& message, std::uint64_t image) {
  if (!response_ || image != response_image_ || !reported_.known || pending_alarm_.active ||
      context.dissection != nullptr || context.settings.judge_every_block) {
    return false;
  }
  response_->frame = context.frame.number;
  response_->time_ns = context.frame.time_ns;
  track_operation(*response_);
  judge_echoes(context, message, *response_);
  judge_home_travel(context, message, *response_);
  for (const RuleId id : {rule("YS901"), rule("YS902"), rule("YS903"), rule("YS904"), rule("YS905")}) {
    checked(context, id);
  }
  if (!response_->command_error) refusable_since_ = command_ ? command_->frame : response_->frame;
  expire(context);
  return true;
}

void Session::on_command(const Context& context, const Message& message) {
  if (message.bytes.size() < kMessageSize) return;
  const std::uint64_t image = load_le64(message.bytes, 0);
  if (repeats_command(context, image)) return;
  command_image_ = image;
  waits_ = true;
  add(context, message, kCommand, 0, Direction::kCommand);
  const Command command = read_command(message.bytes, context.frame.number, context.frame.time_ns);
  add(context, message, command_data(command.code), kDataOffset, Direction::kCommand);
  expire(context);
  command_clean_ = true;
  judge_data(context, message, command);
  judge_levels(context, message, command);
  judge_start(context, message, command);
  judge_unchanged_start(context, message, command);
  if (!command.valid_data) {
    valid_wait_.end();
  } else if (!command_ || !command_->valid_data) {
    valid_wait_.begin(command.frame, command.time_ns);
  }
  command_ = command;
}

void Session::on_response(const Context& context, const Message& message) {
  if (message.bytes.size() < kMessageSize) return;
  const std::uint64_t image = load_le64(message.bytes, 0);
  if (repeats_response(context, message, image)) return;
  response_image_ = image;
  waits_ = true;
  add(context, message, kResponse, 0, Direction::kResponse);
  const Response response = read_response(message.bytes, context.frame.number, context.frame.time_ns);
  add(context, message, response_data(response.code), kDataOffset, Direction::kResponse);
  if (response.is(ResponseCode::kAlarmCode)) show_alarm(context, response.data);
  track_operation(response);
  judge_echoes(context, message, response);
  judge_home_travel(context, message, response);
  judge_reports(context, message, response);
  response_ = response;
  expire(context);
}

void Session::show_alarm(const Context& context, std::int64_t code) const {
  const Alarm* alarm = find_alarm(code);
  if (alarm == nullptr || context.dissection == nullptr) return;
  add(context, kAlarmSgdhText, "ns310", 0, alarm->sgdh);
  add(context, kAlarmIndicatorText, "ns310", 0, kIndicatorNames[static_cast<std::size_t>(alarm->indicator)]);
  add(context, kAlarmCausesText, "ns310", 0, alarm->causes);
  add(context, kAlarmRemediesText, "ns310", 0, alarm->remedies);
}

void Session::on_time(const Context& context) {
  expire(context);
  waits_ = pending_alarm_.active || pending_block_fault_.active || settle_pending_;
}

void Session::on_start(const Context&) {
  on_gap();
  reported_.known = false;
  start_seen_ = true;
  homed_ = false;
  needs_reset_.active = false;
  if (written_direction_.basis.kind == BasisKind::kCapture) reference_direction_ = written_direction_;
  blocks_.forget();
  sequencer_block_.reset();
}

void Session::on_gap() {
  command_.reset();
  response_.reset();
  valid_wait_.end();
  start_wait_.end();
  edge_wait_.end();
  continuous_wait_.end();
  error_cleared_ = true;
  started_.reset();
  rotation_.reset();
  operation_ = Operation::kUnknown;
  candidate_ = Operation::kUnknown;
  position_.reset();
  start_seen_ = false;  // a homing may have been lost
  // So may a Set or a Reset: what is shown stays, what is judged is not known any more.
  blocks_.doubt();
  for (Setting* setting :
       {&gear_numerator_, &gear_denominator_, &acceleration_, &filter_, &jog_acceleration_, &reference_direction_}) {
    setting->certain = false;
  }
  needs_reset_.active = false;
  sequencer_block_.reset();
}

void Session::on_finish(const Context& context) {
  if (pending_alarm_.active) issue_alarm(context, kCodeNotRead, {});
  if (pending_block_fault_.active) issue_block_fault(context, kCodeNotRead);
}

void Session::summarise(NodeSummary& summary, std::vector<Statistic>& statistics) const {
  const auto fact = [&summary](std::string_view key, const Setting& setting) {
    if (setting.basis.kind != BasisKind::kCapture) return;
    summary.facts.push_back({std::string(key), std::to_string(setting.value), setting.basis});
  };
  fact("25h/24 Reference Direction", reference_direction_);
  fact("64h/30 Electronic Gear (Numerator)", gear_numerator_);
  fact("64h/31 Electronic Gear (Denominator)", gear_denominator_);
  fact("64h/56 Accel/Decel Type for Positioning", acceleration_);
  fact("64h/58 Filter Selection", filter_);
  fact("64h/65 Profile Type For JOG", jog_acceleration_);
  for (unsigned number = 1; number < 256; ++number) {
    const Block& block = blocks_.at(static_cast<std::uint8_t>(number));
    if (!block.command_known) continue;
    BlockText text;
    append_block(text, static_cast<std::uint8_t>(number), block);
    const std::string_view all = text.view();
    const std::size_t colon = all.find(": ");
    summary.facts.push_back(
        {std::string(all.substr(0, colon)), std::string(all.substr(colon + 2)), {BasisKind::kCapture, block.frame}});
  }
  append_statistic(statistics, "valid data echo", node(), valid_echo_);
  append_statistic(statistics, "start echo", node(), start_echo_);
}

const DriveProfile& Profile::row() { return kProfile; }

std::unique_ptr<DriveSession> make_session(const Settings& settings, const NodeRef& node, OwnerId owner,
                                           bool decode_only) {
  return std::make_unique<Session>(settings, node, owner, decode_only);
}

}  // namespace servotrace::ns310
