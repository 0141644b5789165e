// SPDX-License-Identifier: MIT
// SARIF 2.1.0. A capture is binary: the region is the frame's bytes in the file. Consumers that want lines get
// `sarif-github`: the line is the frame, one result a rule and node, and no more than they take.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "decoder/render/json.hpp"
#include "decoder/render/value.hpp"
#include "replay/exit_status.hpp"
#include "replay/output/output.hpp"

namespace servotrace::replay {
namespace {

constexpr std::size_t kMostForGithub = 5000;  // results a run that GitHub shows

// The characters a URI keeps (RFC 3986 unreserved, and the slash between folders).
std::string uri_of(std::string_view file) {
  std::string uri = file.starts_with('/') ? "file://" : "";
  for (const char c : file) {
    const bool keeps = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
                       c == '.' || c == '_' || c == '~' || c == '/';
    if (keeps) {
      uri += c;
    } else {
      uri += fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    }
  }
  return uri == "-" ? "stdin" : uri;
}

// update-counter-stuck to UpdateCounterStuck, as SARIF wants names of rules.
std::string camel(std::string_view slug) {
  std::string name;
  bool upper = true;
  for (const char c : slug) {
    if (c == '-') {
      upper = true;
      continue;
    }
    name += upper && c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    upper = false;
  }
  return name;
}

// FNV-1a, 64 bits: a fingerprint must be the same on every machine, and holds no secret.
std::string fingerprint(std::string_view text) {
  std::uint64_t hash = 0xCBF29CE484222325U;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001B3U;
  }
  return fmt::format("{:016x}", hash);
}

class Sarif : public Output {
 public:
  Sarif(Out& out, bool for_github) : Output(out), for_github_(for_github) {}

  void begin() override {
    json_.begin_object();
    json_.member("$schema", "https://json.schemastore.org/sarif-2.1.0.json");
    json_.member("version", "2.1.0");
    json_.key("runs").begin_array().begin_object();
    json_.key("tool").begin_object().key("driver").begin_object();
    json_.member("name", "servotrace").member("version", SERVOTRACE_VERSION);
    json_.member("semanticVersion", SERVOTRACE_VERSION);
    json_.key("rules").begin_array();
    for (const Rule& row : kCatalogue) write_rule(row);
    json_.end_array().end_object().end_object();
    json_.key("results").begin_array();
    hand_over();
  }

  void capture(const CaptureRecord& capture) override {
    if (!capture.error.empty()) notices_.push_back({"error", capture.error});
    if (for_github_) {
      collapse(capture);
      return;
    }
    std::map<std::string, unsigned> seen;
    for (const FindingRecord& finding : capture.findings) {
      write_result(capture, finding, finding.message, ++seen[identity(capture, finding)]);
      hand_over();
    }
  }

  void end(const RunTotals& totals) override {
    if (for_github_) write_collapsed();
    json_.end_array();
    json_.key("invocations").begin_array().begin_object();
    json_.member("executionSuccessful", totals.status != kExitFailed).member("exitCode", totals.status);
    json_.key("toolExecutionNotifications").begin_array();
    for (const Notice& notice : notices_) {
      json_.begin_object().member("level", notice.level);
      write_text("message", notice.text);
      json_.end_object();
    }
    json_.end_array().end_object().end_array();
    json_.end_object().end_array().end_object();
    text_ += '\n';
    hand_over();
  }

 private:
  // What went wrong in the run itself.
  struct Notice {
    std::string_view level;
    std::string text;
  };
  struct Collapsed {
    CaptureRecord capture;  // without its lists
    FindingRecord finding;
    std::uint64_t findings = 0;
  };

  void hand_over() {
    out().write(text_);
    text_.clear();
  }

  void write_text(std::string_view key, std::string_view text) {
    json_.key(key).begin_object().member("text", text).end_object();
  }

  void write_rule(const Rule& row) {
    json_.begin_object().member("id", row.id).member("name", camel(row.slug));
    write_text("shortDescription", row.title);
    write_text("fullDescription", row.why);
    write_text("help", row.fix);
    json_.key("defaultConfiguration").begin_object().member("level", name_of(row.severity)).end_object();
    json_.key("properties").begin_object();
    json_.member("slug", row.slug).member("actor", name_of(row.actor)).member("manual", row.section);
    json_.key("tags").begin_array().value(name_of(row.actor)).end_array();
    json_.end_object().end_object();
  }

  // What makes a finding the same one in another recording: never its frame.
  static std::string identity(const CaptureRecord& capture, const FindingRecord& finding) {
    const NodeName& node = finding.node;
    return fmt::format("{}\n{}\n{}\n{}\n{}", capture.file, finding.row().id, node.bus,
                       node.mac_id ? fmt::format("{}", *node.mac_id) : "", node.channel);
  }

  void write_place(const CaptureRecord& capture, std::uint64_t frame, const FramePlace& place) {
    json_.key("physicalLocation").begin_object();
    json_.key("artifactLocation").begin_object().member("uri", uri_of(capture.file)).end_object();
    if (for_github_) {
      json_.key("region").begin_object().member("startLine", frame).end_object();
    } else if (place.length != 0) {
      json_.key("region").begin_object();
      json_.member("byteOffset", place.offset).member("byteLength", std::uint64_t{place.length}).end_object();
    }
    json_.end_object();
  }

  void write_result(const CaptureRecord& capture, const FindingRecord& finding, const std::string& words,
                    unsigned occurrence) {
    const std::string who = capture.who(finding.node);
    json_.begin_object();
    json_.member("ruleId", finding.row().id);
    json_.member("ruleIndex", static_cast<std::uint64_t>(finding.rule));
    json_.member("level", name_of(finding.severity));
    write_text("message", who.empty() ? words : fmt::format("{}: {}", who, words));
    json_.key("locations").begin_array().begin_object();
    write_place(capture, finding.frame, finding.place);
    if (!finding.node.bus.empty()) {
      const std::string node = finding.node.mac_id ? finding.node.text() : "";
      json_.key("logicalLocations").begin_array().begin_object();
      json_.member("name", node.empty() ? finding.node.bus : node);
      json_.member("fullyQualifiedName",
                   node.empty() ? finding.node.bus : fmt::format("{}/{}", finding.node.bus, node));
      json_.member("kind", "resource").end_object().end_array();
    }
    json_.end_object().end_array();
    if (!finding.related.empty()) {
      json_.key("relatedLocations").begin_array();
      for (const std::uint64_t frame : finding.related) {
        json_.begin_object();
        write_place(capture, frame, {});
        write_text("message", fmt::format("frame {}", frame));
        json_.end_object();
      }
      json_.end_array();
    }
    const std::string print = fmt::format("{}:{}", fingerprint(identity(capture, finding)), occurrence);
    json_.key("partialFingerprints").begin_object();
    json_.member(for_github_ ? "primaryLocationLineHash" : "servotrace/v1", print).end_object();
    json_.key("properties").begin_object();
    json_.member("frame", finding.frame).member("lastFrame", finding.last_frame).member("count", finding.count);
    json_.member("time", seconds_text(finding.time_ns)).member("actor", name_of(finding.actor));
    json_.end_object().end_object();
  }

  void collapse(const CaptureRecord& capture) {
    for (const FindingRecord& finding : capture.findings) {
      const auto [entry, is_new] = places_.try_emplace(identity(capture, finding), collapsed_.size());
      if (is_new) {
        Collapsed& added = collapsed_.emplace_back();
        added.capture.file = capture.file;
        for (const NodeRecord& node : capture.nodes) {
          if (!node.node.mac_id) added.capture.nodes.push_back(node);
        }
        added.finding = finding;
      }
      Collapsed& known = collapsed_[entry->second];
      ++known.findings;
      known.finding.severity = std::max(known.finding.severity, finding.severity);
    }
  }

  void write_collapsed() {
    std::stable_sort(collapsed_.begin(), collapsed_.end(), [](const Collapsed& left, const Collapsed& right) {
      return left.finding.severity > right.finding.severity;
    });
    if (collapsed_.size() > kMostForGithub) {
      notices_.push_back({"warning", fmt::format("{} results are left out, the least severe ones",
                                                 collapsed_.size() - kMostForGithub)});
      collapsed_.resize(kMostForGithub);
    }
    for (const Collapsed& entry : collapsed_) {
      std::string words = entry.finding.message;
      if (entry.findings > 1) words += fmt::format(" (first of {} findings)", entry.findings);
      write_result(entry.capture, entry.finding, words, 1);
      hand_over();
    }
  }

  bool for_github_;
  std::string text_;
  JsonWriter json_{text_, 1};
  std::vector<Notice> notices_;
  std::map<std::string, std::size_t> places_;  // identity to its place in collapsed_
  std::vector<Collapsed> collapsed_;
};

}  // namespace

std::unique_ptr<Output> make_sarif(Out& out, const OutputOptions&) { return std::make_unique<Sarif>(out, false); }
std::unique_ptr<Output> make_sarif_github(Out& out, const OutputOptions&) { return std::make_unique<Sarif>(out, true); }

}  // namespace servotrace::replay
