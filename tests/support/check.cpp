// SPDX-License-Identifier: MIT
#include "tests/support/check.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "decoder/pipeline/pipeline.hpp"
#include "decoder/render/node.hpp"
#include "replay/capture/source.hpp"

namespace servotrace::test {
namespace {

std::string node_name(const NodeRef& node, const Settings& settings) {
  if (node.mac_id != kNoMacId) return node_text(node, configured_name(settings, node));
  if (node.bus.kind == BusKind::kRing) return "ring" + std::to_string(node.bus.number);
  if (node.bus.kind == BusKind::kCan) return "can";
  return "capture";
}

}  // namespace

std::string to_string(const Seen& seen) {
  return std::to_string(seen.frame) + " " + seen.rule + " " + seen.severity + " " + seen.node;
}

std::vector<Seen> check_capture(const std::filesystem::path& capture, const replay::FileSettings& settings) {
  std::vector<Seen> all;
  Result<std::unique_ptr<replay::Source>> source = replay::open_capture(capture);
  if (!source) {
    ADD_FAILURE() << source.error().text();
    return all;
  }
  Pipeline pipeline(settings.decoder);
  replay::RuleFilter filter(settings.rules);
  RawFrame frame;
  while ((*source)->next(frame) == replay::Source::Step::kFrame) {
    pipeline.push(frame);
    for (Finding finding : pipeline.fresh()) {
      const Rule& row = rule_row(finding.rule);
      if (row.hosts == Hosts::kOfflineOnly || !filter.apply(finding)) continue;
      all.push_back({finding.frame, std::string(row.id), std::string(name_of(finding.severity)),
                     node_name(finding.node, settings.decoder)});
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace servotrace::test
