// SPDX-License-Identifier: MIT
// servotrace annotate: the capture again with every finding as a packet comment. A finding stands on the frame that
// proves it, so one pass suffices; the last frame waits for what only the end shows.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <vector>

#include "replay/capture/cooked_can.hpp"
#include "replay/capture/interrupt.hpp"
#include "replay/capture/pcapng_writer.hpp"
#include "replay/commands.hpp"
#include "replay/console.hpp"
#include "replay/exit_status.hpp"
#include "replay/inputs.hpp"
#include "replay/judge.hpp"

namespace servotrace::replay {
namespace {

class Annotator : public FrameVisitor {
 public:
  Annotator(PcapngWriter& writer, const FileSettings& settings, const Selection& selection)
      : writer_(writer), settings_(settings), selection_(selection), filter_(selection.filter(settings.rules)) {}

  Detail wanted_of(const RawFrame&) override { return Detail::kNothing; }

  bool on_frame(const RawFrame& frame, const Dissection*, const Pipeline& pipeline, const Source& source) override {
    write_held();
    source_ = &source;
    for (std::size_t i = interfaces_; i < source.interfaces().size(); ++i) {
      writer_.add_interface(source.interfaces()[i].link_type, source.interfaces()[i].name);
    }
    interfaces_ = source.interfaces().size();
    const Bytes bytes = as_little_endian(frame, turned_);
    held_.assign(bytes.begin(), bytes.end());
    frame_ = frame;
    has_frame_ = true;
    add(pipeline);
    return true;
  }
  void on_end(const Pipeline& pipeline) override { add(pipeline); }

  void finish() { write_held(); }
  std::uint64_t findings() const { return findings_; }

 private:
  void add(const Pipeline& pipeline) {
    if (pipeline.fresh().empty() || source_ == nullptr) return;
    CaptureResult names;
    names.summary = pipeline.summary();
    names.buses = BusNames(names.summary, source_->interfaces());
    for (Finding finding : pipeline.fresh()) {
      if (!selection_.is_of_actor(finding.actor) || !filter_.apply(finding)) continue;
      const FindingRecord record = make_record(finding, names, settings_.decoder);
      const std::string who = record.node.text();
      if (!comment_.empty()) comment_ += '\n';
      comment_ += fmt::format("{}[{}] {}{}{}", name_of(record.severity), record.row().id, who, who.empty() ? "" : ": ",
                              record.message);
      ++findings_;
    }
  }

  void write_held() {
    if (has_frame_) writer_.write(frame_.interface_id, frame_.time_ns, held_, frame_.original_length, comment_);
    comment_.clear();
    has_frame_ = false;
  }

  PcapngWriter& writer_;
  const FileSettings& settings_;
  const Selection& selection_;
  RuleFilter filter_;
  const Source* source_ = nullptr;
  std::size_t interfaces_ = 0;
  std::vector<std::uint8_t> held_;
  std::vector<std::uint8_t> turned_;
  RawFrame frame_;
  bool has_frame_ = false;
  std::string comment_;
  std::uint64_t findings_ = 0;
};

}  // namespace

int run_annotate(const Arguments& arguments) {
  CLI::App app("The capture again, with every finding as a packet comment: readable in any Wireshark.",
               "servotrace annotate");
  std::string capture;
  std::string out_path;
  std::vector<std::string> select;
  std::vector<std::string> ignore;
  std::vector<std::string> actors;
  CaptureOptions capture_options;
  app.add_option("CAPTURE", capture, "A file, or - for standard input")->required();
  app.add_option("-o,--output", out_path, "The capture to write (.pcapng)")->required()->type_name("FILE");
  capture_options.add_to(app);
  app.add_option("--select", select, "Only these rules: ids or prefixes (RX3, DN)")
      ->type_name("RULES")
      ->allow_extra_args(false);
  app.add_option("--ignore", ignore, "Not these rules: ids or prefixes")->type_name("RULES")->allow_extra_args(false);
  app.add_option("--actor", actors, "Only findings of these: master, drive, network, capture")
      ->type_name("ACTORS")
      ->allow_extra_args(false);
  app.footer(
      "Exit status: 0 done, 2 could not do the job.\n\n"
      "Example:\n  servotrace annotate run.pcapng -o run.annotated.pcapng\n"
      "  tshark -r run.annotated.pcapng -Y frame.comment");
  if (const std::optional<int> status = parse(app, arguments)) return *status;
  const auto fail = [](const Error& error) {
    complain(error);
    return kExitFailed;
  };
  const Result<Selection> selection = Selection::make(select, ignore, actors, "never");
  if (!selection) return fail(selection.error());
  const Result<CaptureInput> input = single_input(capture);
  if (!input) return fail(input.error());
  const auto settings = capture_options.settings(input->path);
  if (!settings) return fail(settings.error());
  const Result<std::unique_ptr<Source>> source = open_input(*input);
  if (!source) return fail(source.error());
  const Result<std::unique_ptr<PcapngWriter>> writer = PcapngWriter::create(out_path);
  if (!writer) return fail(writer.error());
  Annotator annotator(**writer, **settings, *selection);
  catch_interrupts();
  const CaptureResult result = run(**source, input->name, (*settings)->decoder,
                                   {.visitor = &annotator, .stop = &interrupted(), .on_progress = {}});
  // A stream that is interrupted ends like a capture.
  if (result.stopped && !input->is_stream()) return fail(not_written({"", "interrupted"}, out_path));
  if (result.error) return fail(not_written(*result.error, out_path));
  annotator.finish();
  if (const Result<void> written = (*writer)->finish(); !written) return fail(written.error());
  return kExitClean;
}

}  // namespace servotrace::replay
