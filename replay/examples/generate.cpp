// SPDX-License-Identifier: MIT
// Writes the examples of `servotrace explain` from the scenarios: what the checker says where a rule is broken, and
// what the frames say where the rule looked and found all in order.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "captures/simulator/scenario.hpp"
#include "decoder/render/value.hpp"
#include "replay/evidence.hpp"
#include "replay/examples/simulated_source.hpp"
#include "replay/results.hpp"
#include "replay/settings/settings.hpp"

namespace servotrace::replay {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostLines = 6;        // of a trace
constexpr std::uint64_t kLookBack = 64;      // frames a line of the silent trace may lie before its counterpart
constexpr std::size_t kMostScenarios = 200;  // tried for a silent trace

struct Line {
  std::uint64_t frame = 0;
  TimeNs since_ns = 0;  // since the first frame
  std::string text;
};

// A scenario that was run: its result, and of each frame what it says about every node.
struct Run {
  simulator::Simulation simulation;
  Settings settings;
  CaptureResult result;
  // For each rule the frames at which it was looked at.
  std::map<std::size_t, std::vector<std::uint64_t>> looked;
};

[[noreturn]] void die(const std::string& message) {
  fmt::print(stderr, "generate_examples: {}\n", message);
  std::exit(2);
}

class Looks : public FrameVisitor {
 public:
  explicit Looks(Run& run) : run_(run) {}
  Detail wanted_of(const RawFrame&) override { return Detail::kNothing; }
  bool on_frame(const RawFrame& frame, const Dissection*, const Pipeline& pipeline, const Source&) override {
    for (std::size_t i = 0; i < kRuleCount; ++i) {
      const std::uint64_t times = pipeline.findings().times_checked(static_cast<RuleId>(i));
      if (times != times_[i]) run_.looked[i].push_back(frame.number);
      times_[i] = times;
    }
    return true;
  }

 private:
  Run& run_;
  std::array<std::uint64_t, kRuleCount> times_ = {};
};

class Runs {
 public:
  const Run& of(const simulator::Scenario& scenario) {
    std::unique_ptr<Run>& entry = runs_[scenario.name];
    if (entry != nullptr) return *entry;
    entry = std::make_unique<Run>();
    Result<simulator::Simulation> simulation = simulator::simulate(scenario);
    if (!simulation) die(simulation.error().text());
    entry->simulation = std::move(*simulation);
    const Result<FileSettings> settings = parse_settings(scenario.settings, scenario.origin);
    if (!settings) die(settings.error().text());
    entry->settings = settings->decoder;
    Looks looks(*entry);
    SimulatedSource source(entry->simulation);
    entry->result = run(source, scenario.name, entry->settings, {.visitor = &looks, .stop = {}, .on_progress = {}});
    return *entry;
  }

 private:
  std::map<std::string, std::unique_ptr<Run>> runs_;
};

// What frames say about one node: `wanted`, or where a frame does not speak of it the nearest one before that does.
class Lines : public FrameVisitor {
 public:
  Lines(const Run& run, const NodeRef& node, std::set<std::uint64_t> wanted)
      : run_(run), node_(node), wanted_(std::move(wanted)) {}

  bool on_frame(const RawFrame& frame, const Dissection* dissection, const Pipeline&, const Source&) override {
    if (frame.number == 1) first_ns_ = frame.time_ns;
    if (dissection != nullptr && speaks(*dissection)) {
      last_ = {frame.number, elapsed_ns(first_ns_, frame.time_ns),
               frame_words(frame, *dissection, there_, run_.settings)};
    }
    if (wanted_.contains(frame.number) && last_.frame != 0 && !last_.text.empty() &&
        frame.number - last_.frame <= kLookBack && (lines_.empty() || lines_.back().frame != last_.frame)) {
      lines_.push_back(last_);
    }
    return frame.number < *wanted_.rbegin();
  }
  std::vector<Line> take() { return std::move(lines_); }

 private:
  bool speaks(const Dissection& dissection) {
    there_ = node_;
    if (node_.mac_id == kNoMacId) return true;
    for (const Segment& segment : dissection.segments) {
      if (segment.node.protocol != node_.protocol || segment.node.mac_id != node_.mac_id) continue;
      there_ = segment.node;
      return true;
    }
    return false;
  }

  const Run& run_;
  NodeRef node_;
  NodeRef there_;
  std::set<std::uint64_t> wanted_;
  TimeNs first_ns_ = 0;
  Line last_;
  std::vector<Line> lines_;
};

std::vector<Line> lines_of(const Run& from, const NodeRef& node, const std::set<std::uint64_t>& frames) {
  Lines lines(from, node, frames);
  SimulatedSource source(from.simulation);
  run(source, "", from.settings, {.visitor = &lines, .stop = {}, .on_progress = {}});
  return lines.take();
}

std::string text_of(const std::vector<Line>& lines, std::uint64_t marked) {
  std::string text;
  for (std::size_t i = lines.size() > kMostLines ? lines.size() - kMostLines : 0; i < lines.size(); ++i) {
    const TimeNs microseconds = lines[i].since_ns / 1000;
    fmt::format_to(std::back_inserter(text), "{} {:>5}  {:>3}.{:06}  {}\n", lines[i].frame == marked ? '>' : ' ',
                   lines[i].frame, microseconds / 1'000'000, microseconds % 1'000'000, lines[i].text);
  }
  return text;
}

// The frames of a finding: those related, and the one that proves it.
std::set<std::uint64_t> frames_of(const Finding& finding) {
  std::set<std::uint64_t> frames(finding.related.begin(), finding.related.end());
  frames.erase(0);
  frames.insert(finding.frame);
  return frames;
}

std::string violation_trace(const Run& from, const Finding& finding) {
  const FindingRecord record = make_record(finding, from.result, from.settings);
  const std::string who = record.node.text();
  return fmt::format("frame {}: {}[{}] {}{}{}\n", record.frame, name_of(record.severity), record.row().id, who,
                     who.empty() ? "" : ": ", record.message) +
         text_of(lines_of(from, finding.node, frames_of(finding)), finding.frame);
}

// The node of the silent run that stands for `node`: of the same MAC ID, else the first of its protocol.
NodeRef counterpart(const Run& from, const NodeRef& node) {
  NodeRef first;
  for (const BusSummary& bus : from.result.summary.buses) {
    for (const NodeSummary& entry : bus.nodes) {
      if (entry.node.protocol != node.protocol || node.mac_id == kNoMacId) continue;
      if (entry.node.mac_id == node.mac_id) return entry.node;
      if (first.mac_id == kNoMacId) first = entry.node;
    }
  }
  return first;
}

// Empty: the rule was not looked at in this run.
std::string silent_trace(const Run& from, const Run& broken, const Finding& finding) {
  const auto looked = from.looked.find(static_cast<std::size_t>(finding.rule));
  if (looked == from.looked.end()) return "";
  // The look nearest to where the other scenario breaks the rule: the two tell the same story up to there.
  const TimeNs when = elapsed_ns(*broken.result.first_time_ns, finding.time_ns);
  std::uint64_t best = 0;
  TimeNs best_distance = 0;
  for (const std::uint64_t frame : looked->second) {
    const TimeNs since = elapsed_ns(*from.result.first_time_ns, from.simulation.frames[frame - 1].time_ns);
    const TimeNs distance = std::abs(since - when);
    if (best != 0 && distance >= best_distance) continue;
    best = frame;
    best_distance = distance;
  }
  std::set<std::uint64_t> frames{best};
  for (const std::uint64_t frame : frames_of(finding)) {
    const std::uint64_t back = finding.frame - std::min(frame, finding.frame);
    if (back < best) frames.insert(best - back);
  }
  if (frames.size() == 1 && best > 1) frames.insert(best - 1);
  return text_of(lines_of(from, counterpart(from, finding.node), frames), best);
}

bool holds(const std::vector<std::string>& list, std::string_view id) {
  return std::find(list.begin(), list.end(), id) != list.end();
}

// Scenarios whose list `member` names the rule, those named after the rule first.
std::vector<const simulator::Scenario*> about(const std::vector<simulator::Scenario>& scenarios,
                                              std::vector<std::string> simulator::Scenario::*member,
                                              std::string_view id) {
  std::vector<const simulator::Scenario*> list;
  for (const simulator::Scenario& scenario : scenarios) {
    if (holds(scenario.*member, id)) list.push_back(&scenario);
  }
  std::string prefix(id);
  std::transform(prefix.begin(), prefix.end(), prefix.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  std::stable_partition(list.begin(), list.end(),
                        [&](const simulator::Scenario* scenario) { return scenario->name.starts_with(prefix); });
  return list;
}

std::string literal(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '\n') {
      out += "\\n";
    } else {
      if (c == '"' || c == '\\') out += '\\';
      out += c;
    }
  }
  return out + "\"";
}

std::string literal_lines(std::string_view text) {
  if (text.empty()) return " \"\"";
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
    out += "\n     " + literal(text.substr(0, end));
    text.remove_prefix(end);
  }
  return out;
}

std::string example(const simulator::Scenario* scenario, const std::string& trace) {
  if (scenario == nullptr) return "{}";
  return fmt::format("{{{}, {},{}}}", literal(scenario->name), literal(scenario->title), literal_lines(trace));
}

std::string table(const std::vector<simulator::Scenario>& scenarios) {
  std::string text =
      "// SPDX-License-Identifier: MIT\n"
      "// Made by generate_examples (target `reference`) from captures/scenarios: do not edit.\n";
  Runs runs;
  for (const Rule& row : kCatalogue) {
    const simulator::Scenario* broken = nullptr;
    const Finding* finding = nullptr;
    for (const simulator::Scenario* scenario : about(scenarios, &simulator::Scenario::rules, row.id)) {
      for (const Finding& entry : runs.of(*scenario).result.findings) {
        if (finding == nullptr && rule_row(entry.rule).id == row.id) finding = &entry;
      }
      broken = scenario;
      if (finding != nullptr) break;
    }
    if (finding == nullptr) continue;
    const Run& violating = runs.of(*broken);
    const simulator::Scenario* silent = nullptr;
    std::string trace;
    std::size_t tried = 0;
    for (const simulator::Scenario* scenario : about(scenarios, &simulator::Scenario::silent, row.id)) {
      if (!trace.empty() || ++tried > kMostScenarios) break;
      trace = silent_trace(runs.of(*scenario), violating, *finding);
      if (!trace.empty()) silent = scenario;
    }
    text += fmt::format("{{{},\n {},\n {}}},\n", literal(row.id), example(broken, violation_trace(violating, *finding)),
                        example(silent, trace));
  }
  return text;
}

std::string read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

int generate(const fs::path& folder, const fs::path& file, bool check) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".toml") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<simulator::Scenario> scenarios;
  for (const fs::path& path : paths) {
    Result<simulator::Scenario> scenario = simulator::read_scenario(path);
    if (!scenario) die(scenario.error().text());
    scenarios.push_back(std::move(*scenario));
  }
  const std::string text = table(scenarios);
  if (read_file(file) == text) return 0;
  if (check) {
    fmt::print(stderr, "{} is not current: run the target `reference`\n", file.string());
    return 1;
  }
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << text;
  out.close();
  if (!out) die("cannot write " + file.string());
  return 0;
}

}  // namespace
}  // namespace servotrace::replay

int main(int argc, char** argv) {
  if (argc < 3 || argc > 4 || (argc == 4 && std::string_view(argv[3]) != "--check")) {
    fmt::print(stderr, "usage: generate_examples SCENARIO_FOLDER FILE [--check]\n");
    return 2;
  }
  return servotrace::replay::generate(argv[1], argv[2], argc == 4);
}
