// SPDX-License-Identifier: MIT
// servotrace decode: every message, field by field.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "decoder/render/dissection_json.hpp"
#include "decoder/render/dissection_text.hpp"
#include "decoder/render/message.hpp"
#include "decoder/render/sentence.hpp"
#include "decoder/render/value.hpp"
#include "replay/commands.hpp"
#include "replay/console.hpp"
#include "replay/exit_status.hpp"
#include "replay/inputs.hpp"
#include "replay/results.hpp"

namespace servotrace::replay {
namespace {

struct DecodeOptions {
  std::string capture;
  std::string format = "text";
  std::string colour = "auto";
  std::uint64_t first = 1;
  std::uint64_t last = UINT64_MAX;
  bool brief = false;
  bool explain = false;
  bool all = false;
};

std::string_view direction_word(Direction direction) {
  if (direction == Direction::kCommand) return "command";
  return direction == Direction::kResponse ? "response" : "";
}

class Decoder : public FrameVisitor {
 public:
  Decoder(const DecodeOptions& options, const Settings& settings, Out& out)
      : options_(options), settings_(settings), out_(out) {}

  Detail wanted_of(const RawFrame& frame) override {
    return frame.number >= options_.first && frame.number <= options_.last ? Detail::kAll : Detail::kNothing;
  }

  bool on_frame(const RawFrame& frame, const Dissection* dissection, const Pipeline& pipeline,
                const Source& source) override {
    if (dissection != nullptr && (options_.all || dissection->protocol != Protocol::kNone)) {
      // A bus that was not there before may give the others new names.
      if (names_.name(dissection->bus).empty()) names_ = BusNames(pipeline.summary(), source.interfaces());
      if (options_.format == "jsonl") {
        write_json_line(frame, *dissection, pipeline);
      } else {
        write_text(frame, *dissection, pipeline);
      }
    }
    return frame.number < options_.last && !out_.is_closed();
  }

 private:
  void write_text(const RawFrame& frame, const Dissection& dissection, const Pipeline& pipeline) {
    text_.clear();
    const auto to = std::back_inserter(text_);
    const std::string_view bus = names_.name(dissection.bus);
    std::string words = sentence(dissection, &settings_);
    if (words.empty()) words = fmt::format("{} bytes that are none of a known bus", frame.bytes.size());
    fmt::format_to(to, "{}{}{} {}{}{}{} {}\n", style_.bold(), frame.number, style_.reset(),
                   frame.has_time ? time_text(frame.time_ns) : "(no time)", bus.empty() ? "" : " ", bus,
                   bus.empty() ? "" : ":", words);
    if (!options_.brief) {
      append_text(text_, dissection, settings_, {.explanations = options_.explain, .reserved = options_.all});
    }
    for (const Finding& finding : pipeline.fresh()) {
      fmt::format_to(to, "  {}[{}] {}\n", name_of(finding.severity), rule_row(finding.rule).id, message(finding));
    }
    out_.write(text_);
  }

  void write_json_line(const RawFrame& frame, const Dissection& dissection, const Pipeline& pipeline) {
    text_.clear();
    JsonWriter json(text_);
    json.begin_object().member("type", "frame").member("file", options_.capture).member("frame", frame.number);
    json.key("time");
    if (frame.has_time) {
      json.value(seconds_text(frame.time_ns));
    } else {
      json.null();
    }
    json.member("bus", names_.name(dissection.bus));
    json.member("protocol", servotrace::name_of(dissection.protocol));
    json.member("direction", direction_word(dissection.direction));
    json.member("sentence", sentence(dissection, &settings_));
    if (!options_.brief) fields_.write(json, dissection);
    json.key("findings").begin_array();
    for (const Finding& finding : pipeline.fresh()) {
      json.begin_object()
          .member("rule", rule_row(finding.rule).id)
          .member("severity", name_of(finding.severity))
          .member("message", message(finding))
          .end_object();
    }
    json.end_array().end_object();
    text_ += '\n';
    out_.write(text_);
  }

  const DecodeOptions& options_;
  const Settings& settings_;
  Out& out_;
  Style style_{options_.format == "text" && use_colour(when_of(options_.colour).value_or(When::kNever), 1)};
  BusNames names_;
  DissectionJson fields_{settings_};
  std::string text_;
};

}  // namespace

int run_decode(const Arguments& arguments) {
  CLI::App app("Prints every message, field by field.", "servotrace decode");
  DecodeOptions options;
  CaptureOptions capture_options;
  std::string frames;
  app.add_option("CAPTURE", options.capture, "A file, or - for standard input")->required();
  capture_options.add_to(app);
  app.add_option("--format", options.format, "text or jsonl")
      ->check(CLI::IsMember({"text", "jsonl"}))
      ->capture_default_str();
  app.add_option("--frames", frames, "Only these frames: N, N-M, N- or -M")->type_name("RANGE");
  app.add_flag("--brief", options.brief, "One sentence a frame, no fields");
  app.add_flag("--explain", options.explain, "Text: what each field means, and its manual section");
  app.add_flag("--all", options.all, "Frames of no known bus and reserved bits, too");
  app.add_option("--color", options.colour, "auto, always or never")->type_name("WHEN")->capture_default_str();
  app.footer(
      "Exit status: 0 done, 2 could not do the job, 3 no frame of a known bus.\n\n"
      "Examples:\n"
      "  servotrace decode run.pcapng --frames 4700-4720\n"
      "  servotrace decode run.pcapng --brief | less\n"
      "  servotrace decode run.pcapng --format jsonl | jq 'select(.bus == \"ring0\")'");
  if (const std::optional<int> status = parse(app, arguments)) return *status;
  if (!when_of(options.colour)) {
    complain(fmt::format("--color: '{}': must be auto, always or never", options.colour));
    return kExitFailed;
  }
  if (!frames.empty()) {
    const auto range = parse_range(frames);
    if (!range) {
      complain(fmt::format("--frames: '{}' is no range: write N, N-M, N- or -M", frames));
      return kExitFailed;
    }
    options.first = range->first;
    options.last = range->second;
  }
  const Result<CaptureInput> named = single_input(options.capture);
  if (!named) {
    complain(named.error());
    return kExitFailed;
  }
  const CaptureInput& input = *named;
  const auto settings = capture_options.settings(input.path);
  if (!settings) {
    complain(settings.error());
    return kExitFailed;
  }
  StandardOut out;
  Decoder decoder(options, (*settings)->decoder, out);
  const CaptureResult result =
      run_input(input, (*settings)->decoder, {.visitor = &decoder, .stop = {}, .on_progress = {}});
  if (result.error) complain(*result.error);
  if (const Result<void> finished = out.finish(); !finished) {
    complain(finished.error());
    return kExitFailed;
  }
  if (result.error) return kExitFailed;
  if (result.summary.checked_frames == 0 && !options.all) {
    complain(Error{input.name, "no frame of a known bus (11-bit CAN may be DeviceNet: --devicenet)"});
    return kExitNothing;
  }
  return kExitClean;
}

}  // namespace servotrace::replay
