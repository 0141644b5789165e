// SPDX-License-Identifier: MIT
// servotrace export: process values as CSV, one column each, or states and values as a Perfetto trace. The file is read
// twice: first to find the series there are, then to write them.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>

#include "decoder/render/value.hpp"
#include "replay/capture/interrupt.hpp"
#include "replay/capture/whole_file.hpp"
#include "replay/commands.hpp"
#include "replay/console.hpp"
#include "replay/exit_status.hpp"
#include "replay/inputs.hpp"
#include "replay/perfetto.hpp"
#include "replay/signals.hpp"

namespace servotrace::replay {
namespace {

// Finds the series.
class Finder : public FrameVisitor {
 public:
  Finder(SeriesList& list, bool states) : list_(list), states_(states) {}
  bool on_frame(const RawFrame&, const Dissection* dissection, const Pipeline&, const Source&) override {
    if (dissection != nullptr) list_.note(*dissection, states_);
    return true;
  }

 private:
  SeriesList& list_;
  bool states_;
};

// RFC 4180: quotes where they are needed.
std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + "\"";
}

class CsvWriter : public FrameVisitor {
 public:
  CsvWriter(SeriesList& list, const std::vector<Series>& series, TimeNs first_time_ns, WholeFile& file)
      : list_(list), first_time_ns_(first_time_ns), file_(file), row_(series.size()) {
    std::string header = "time_s,epoch_s,frame";
    for (const Series& entry : series) {
      const std::string_view unit = symbol(entry.field->unit);
      header += "," + csv_cell(unit.empty() ? entry.name : fmt::format("{} [{}]", entry.name, unit));
    }
    file_.write(header + "\n");
  }

  bool on_frame(const RawFrame& frame, const Dissection* dissection, const Pipeline&, const Source&) override {
    if (dissection == nullptr) return true;
    bool any = false;
    list_.for_each(*dissection, false, [&](std::size_t number, const Field& field, std::int64_t raw) {
      if (number >= row_.size()) return;
      row_[number] = scaled_text(raw, field.scale);
      any = true;
    });
    if (!any) return !file_.failed();
    std::string line = fmt::format("{},{},{}", seconds_text(elapsed_ns(first_time_ns_, frame.time_ns)),
                                   seconds_text(frame.time_ns), frame.number);
    for (std::string& value : row_) {
      line += ',';
      line += value;
      value.clear();
    }
    file_.write(line + "\n");
    return !file_.failed();
  }

 private:
  SeriesList& list_;
  TimeNs first_time_ns_;
  WholeFile& file_;
  std::vector<std::string> row_;
};

class TraceWriter : public FrameVisitor {
 public:
  TraceWriter(SeriesList& list, const std::vector<Series>& series, WholeFile& file)
      : list_(list), series_(series), file_(file), last_(series.size()) {
    // Groups: "ring0", "ring0.axis3"; then the series, numbered from kFirst.
    std::map<std::string, std::uint64_t> groups;
    for (std::size_t i = 0; i < series.size(); ++i) {
      const std::string& name = series[i].name;
      const std::size_t first_dot = name.find('.');
      const std::size_t second_dot = name.find('.', first_dot + 1);
      const std::uint64_t bus = group(groups, name.substr(0, first_dot), 0);
      const std::uint64_t node = group(groups, name.substr(0, second_dot), bus);
      const std::string rest = name.substr(second_dot + 1);
      if (series[i].field->role == Role::kSignal) {
        trace_.counter_track(kFirst + i, node, rest, symbol(series[i].field->unit));
      } else {
        trace_.track(kFirst + i, node, rest);
      }
    }
    hand_over();
  }

  bool on_frame(const RawFrame& frame, const Dissection* dissection, const Pipeline&, const Source&) override {
    if (dissection == nullptr) return true;
    last_time_ns_ = frame.time_ns;
    list_.for_each(*dissection, true, [&](std::size_t number, const Field& field, std::int64_t raw) {
      if (number >= last_.size()) return;
      std::optional<std::int64_t>& last = last_[number];
      if (last == raw) return;
      if (field.role == Role::kSignal) {
        trace_.counter(kFirst + number, frame.time_ns,
                       static_cast<double>(raw) * field.scale.numerator / field.scale.denominator);
      } else {
        if (is_shown(number, last)) trace_.end_slice(kFirst + number, frame.time_ns);
        if (is_shown(number, raw)) trace_.begin_slice(kFirst + number, frame.time_ns, slice_name(field, raw));
      }
      last = raw;
    });
    hand_over();
    return !file_.failed();
  }

  // Closes what is open.
  void finish() {
    for (std::size_t i = 0; i < series_.size(); ++i) {
      if (series_[i].field->role == Role::kState && is_shown(i, last_[i])) trace_.end_slice(kFirst + i, last_time_ns_);
    }
    hand_over();
  }

 private:
  static constexpr std::uint64_t kFirst = 1'000'000;

  std::uint64_t group(std::map<std::string, std::uint64_t>& groups, const std::string& name, std::uint64_t parent) {
    const auto [entry, is_new] = groups.try_emplace(name, groups.size() + 1);
    if (is_new) {
      const std::size_t dot = name.find('.');
      trace_.track(entry->second, parent, dot == std::string::npos ? name : name.substr(dot + 1));
    }
    return entry->second;
  }

  // A flag that is 0 is no slice.
  bool is_shown(std::size_t number, const std::optional<std::int64_t>& value) const {
    return value && !(series_[number].field->kind == Kind::kBool && *value == 0);
  }
  static std::string slice_name(const Field& field, std::int64_t raw) {
    return field.kind == Kind::kBool ? std::string(field.label) : state_text(field, raw);
  }

  void hand_over() {
    file_.write(text_);
    text_.clear();
  }

  SeriesList& list_;
  const std::vector<Series>& series_;
  WholeFile& file_;
  std::string text_;
  PerfettoWriter trace_{text_};
  std::vector<std::optional<std::int64_t>> last_;
  TimeNs last_time_ns_ = 0;
};

}  // namespace

int run_export(const Arguments& arguments) {
  CLI::App app("Process values as CSV, or states and values as a Perfetto trace, by the ending of OUT.",
               "servotrace export");
  std::string capture;
  std::string out_path;
  CaptureOptions capture_options;
  app.add_option("CAPTURE", capture, "A file")->required();
  app.add_option("-o,--output", out_path, "OUT.csv, or OUT.pftrace for https://ui.perfetto.dev")
      ->required()
      ->type_name("OUT");
  capture_options.add_to(app);
  app.footer(
      "Exit status: 0 done, 2 could not do the job, 3 no frame of a known bus.\n\n"
      "Examples:\n  servotrace export run.pcapng -o run.csv\n  servotrace export run.pcapng -o run.pftrace");
  if (const std::optional<int> status = parse(app, arguments)) return *status;
  const auto fail = [](const Error& error) {
    complain(error);
    return kExitFailed;
  };
  const bool csv = out_path.ends_with(".csv");
  if (!csv && !out_path.ends_with(".pftrace") && !out_path.ends_with(".perfetto-trace")) {
    return fail({out_path, "the ending must be .csv or .pftrace"});
  }
  const Result<CaptureInput> input = single_input(capture);
  if (!input) return fail(input.error());
  if (input->is_stream()) return fail({"-", "a stream cannot be read twice: export needs a file"});
  const auto settings = capture_options.settings(input->path);
  if (!settings) return fail(settings.error());
  const Settings& decoder = (*settings)->decoder;

  SeriesList list;
  Finder finder(list, !csv);
  const CaptureResult found = run_input(*input, decoder, {.visitor = &finder, .stop = {}, .on_progress = {}});
  catch_interrupts();
  if (found.error) return fail(not_written(*found.error, out_path));
  if (found.summary.checked_frames == 0) {
    complain(Error{input->name, "no frame of a known bus"});
    return kExitNothing;
  }
  const std::vector<Series> series = list.named(found.buses);
  const Result<std::unique_ptr<WholeFile>> file = WholeFile::create(out_path);
  if (!file) return fail(file.error());
  CaptureResult again;
  if (csv) {
    CsvWriter writer(list, series, found.first_time_ns.value_or(0), **file);
    again = run_input(*input, decoder, {.visitor = &writer, .stop = &interrupted(), .on_progress = {}});
  } else {
    TraceWriter writer(list, series, **file);
    again = run_input(*input, decoder, {.visitor = &writer, .stop = &interrupted(), .on_progress = {}});
    writer.finish();
  }
  if (again.error) return fail(not_written(*again.error, out_path));
  if (interrupted()) return fail(not_written({"", "interrupted"}, out_path));
  if (const Result<void> written = (*file)->finish(); !written) return fail(written.error());
  return kExitClean;
}

}  // namespace servotrace::replay
