// SPDX-License-Identifier: MIT
// The HTML of one capture: its sections in the order of the report. Each file page_*.cpp holds some of them.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "decoder/pipeline/settings.hpp"
#include "replay/report/build.hpp"
#include "replay/report/svg.hpp"

namespace servotrace::report {

class Page {
 public:
  // `prefix`: of ids, where several captures share the file.
  Page(const Built& built, const Settings& settings, std::string prefix)
      : model_(built.model), buses_(built.buses), settings_(settings), prefix_(std::move(prefix)) {}

  // From the verdict to what the capture cannot show.
  std::string body();
  // Numbers at a glance, and links to the sections.
  std::string head();

 private:
  struct Column {
    std::string_view name;
    bool number = false;
  };

  void add(std::string_view text) { out_ += text; }
  template <class... Arguments>
  void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<Arguments>(arguments)...);
  }
  static std::string e(std::string_view text) { return escape_html(text); }
  // Level 2 is a section of the report.
  void heading(unsigned level, std::string_view text, std::string_view id = {});
  void begin_table(std::initializer_list<Column> columns);
  void end_table() { add("</tbody></table></div>\n"); }
  void figure(std::string_view svg, std::string_view caption);
  static std::string severity(Severity value);
  std::string rule_link(RuleId id) const;
  std::string node_name(const NodeRef& node) const;
  std::string name_of_finding(const Finding& finding) const;
  void evidence(std::uint64_t frame, const NodeRef& node);

  // page_story.cpp
  void verdict();
  void timelines();
  void story();
  void comparison();
  // page_faults.cpp
  void faults();
  void fault(const Fault& fault, std::size_t number);
  void advice(const Fault& fault);
  void causes(const Fault& fault);
  void before(const Fault& fault);
  void at_rest(const Fault& fault);
  void messages(const Fault& fault);
  void message_pair(const MessagePair& pair);
  // page_nodes.cpp
  void nodes();
  void node(const BusSummary& bus, const NodeSummary& node);
  void states(const NodeRef& node);
  void modes(const NodeRef& node);
  void accesses(const NodeRef& node);
  void access_table(const NodeRef& node, std::string_view title, std::initializer_list<AccessKind> kinds);
  void statistics(const BusSummary& bus, const NodeRef* node);
  // page_network.cpp
  void network();
  void ring(const BusSummary& bus);
  void can(const BusSummary& bus);
  void allocations(const BusSummary& bus);
  // page_violations.cpp
  void violations();
  void rule(const std::vector<const Finding*>& findings);
  void in_full(const Finding& finding);
  void limits();

  const Model& model_;
  const replay::BusNames& buses_;
  const Settings& settings_;
  std::string prefix_;
  std::string out_;
};

}  // namespace servotrace::report
