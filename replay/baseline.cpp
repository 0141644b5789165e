// SPDX-License-Identifier: MIT
#include "replay/baseline.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "decoder/render/json.hpp"
#include "replay/console.hpp"

namespace servotrace::replay {
namespace {

constexpr int kVersion = 1;

}  // namespace

Baseline::Key Baseline::key(const FindingRecord& finding) {
  const NodeName& node = finding.node;
  return {std::string(finding.row().id), node.bus, node.protocol, node.mac_id.value_or(-1), node.channel};
}

Result<Baseline> Baseline::read(const std::filesystem::path& path) {
  std::error_code code;
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path, code)) return Error{path.string(), "cannot be opened"};
  std::ostringstream text;
  text << file.rdbuf();
  return parse(text.str(), path.string());
}

Result<Baseline> Baseline::parse(std::string_view text, const std::string& origin) {
  const nlohmann::json root = nlohmann::json::parse(text, nullptr, false);
  if (root.is_discarded()) return Error{origin, "is no JSON"};
  if (!root.is_object() || root.value("servotrace_baseline", nlohmann::json()) != kVersion) {
    return Error{origin,
                 fmt::format("is no baseline of version {} (servotrace check --write-baseline makes one)", kVersion)};
  }
  const auto list = root.find("findings");
  if (list == root.end() || !list->is_array()) return Error{origin, "holds no list 'findings'"};
  Baseline baseline;
  std::size_t index = 0;
  for (const nlohmann::json& entry : *list) {
    const auto wrong = [&](std::string_view what) { return Error{origin, fmt::format("finding {}: {}", index, what)}; };
    ++index;
    if (!entry.is_object()) return wrong("is no object");
    const auto word = [&entry](const char* name) {
      const auto found = entry.find(name);
      return found != entry.end() && found->is_string() ? found->get<std::string>() : std::string();
    };
    const std::string rule = word("rule");
    if (rule.empty()) return wrong("'rule' is missing");
    const auto count = entry.find("count");
    if (count == entry.end() || !count->is_number_unsigned()) return wrong("'count' must be a number, 0 or more");
    int mac_id = -1;
    if (const auto found = entry.find("mac_id"); found != entry.end() && !found->is_null()) {
      if (!found->is_number_unsigned() || found->get<std::uint64_t>() > 63) return wrong("'mac_id' must be 0 to 63");
      mac_id = found->get<int>();
    }
    baseline.counts_[{rule, word("bus"), word("protocol"), mac_id, word("channel")}].accepted +=
        count->get<std::uint64_t>();
  }
  return baseline;
}

bool Baseline::accepts(const FindingRecord& finding) {
  const auto found = counts_.find(key(finding));
  if (found == counts_.end() || found->second.found >= found->second.accepted) return false;
  ++found->second.found;
  return true;
}

std::string Baseline::text() const {
  std::string text;
  JsonWriter json(text, 1);
  json.begin_object().member("servotrace_baseline", kVersion).key("findings").begin_array();
  for (const auto& [key, count] : counts_) {
    if (count.found == 0) continue;
    const auto& [rule, bus, protocol, mac_id, channel] = key;
    json.begin_object().member("rule", rule).member("bus", bus).member("protocol", protocol).key("mac_id");
    if (mac_id < 0) {
      json.null();
    } else {
      json.value(mac_id);
    }
    json.member("channel", channel).member("count", count.found).end_object();
  }
  json.end_array().end_object();
  return text + "\n";
}

std::vector<std::string> Baseline::leftovers() const {
  std::vector<std::string> lines;
  for (const auto& [key, count] : counts_) {
    if (count.found >= count.accepted) continue;
    const auto& [rule, bus, protocol, mac_id, channel] = key;
    const NodeName node{bus, protocol, mac_id < 0 ? std::nullopt : std::optional(mac_id), "", channel};
    const std::string who = node.text();
    lines.push_back(fmt::format("can shrink: {}{}{} accepts {}, found {}", rule, who.empty() ? "" : " of ", who,
                                count.accepted, count.found));
  }
  return lines;
}

Result<void> BaselineKeeper::open(const std::string& read_from, const std::string& write_to) {
  read_from_ = read_from;
  if (!read_from.empty()) {
    Result<Baseline> read = Baseline::read(read_from);
    if (!read) return read.error();
    baseline_ = std::move(*read);
  }
  if (write_to.empty()) return {};
  Result<std::unique_ptr<WholeFile>> opened = WholeFile::create(write_to);
  if (!opened) return opened.error();
  file_ = std::move(*opened);
  return {};
}

void BaselineKeeper::apply(CaptureRecord& capture, const Selection& selection, std::uint32_t most) {
  if (read_from_.empty() && file_ == nullptr) return;
  std::vector<FindingRecord> rest;
  for (FindingRecord& finding : capture.findings) {
    if (file_ != nullptr) written_.add(finding);
    if (file_ == nullptr && !baseline_.accepts(finding)) {
      rest.push_back(std::move(finding));
      continue;
    }
    ++capture.baselined;
    capture.counts.remove(finding.severity);
    for (RuleRecord& rule : capture.rules) {
      if (rule.rule == finding.rule && rule.findings != 0) --rule.findings;
    }
  }
  std::map<Baseline::Key, std::uint32_t> kept;
  std::erase_if(rest, [&](const FindingRecord& finding) { return ++kept[Baseline::key(finding)] > most; });
  capture.findings = std::move(rest);
  capture.status = selection.status(capture);
}

Result<void> BaselineKeeper::finish() {
  if (file_ != nullptr) {
    file_->write(written_.text());
    return file_->finish();
  }
  if (!read_from_.empty()) {
    for (const std::string& line : baseline_.leftovers()) complain(Error{read_from_, line});
  }
  return {};
}

}  // namespace servotrace::replay
