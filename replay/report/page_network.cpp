// SPDX-License-Identifier: MIT
// The network: cycles, misses and CRC errors of a ring; load, answers and connections of DeviceNet.
#include <algorithm>
#include <map>

#include "decoder/findings/catalogue.hpp"
#include "replay/report/analysis.hpp"
#include "replay/report/page.hpp"
#include "replay/report/pages.hpp"
#include "replay/report/pictures.hpp"

namespace servotrace::report {
namespace {

// Frames or times a rule was broken at a node, episodes counted in full.
std::uint64_t times(const Model& model, std::string_view id, const NodeRef& node) {
  std::uint64_t sum = 0;
  for (const Finding& finding : model.findings) {
    if (rule_row(finding.rule).id == id && finding.node.bus == node.bus && finding.node.mac_id == node.mac_id)
      sum += finding.count;
  }
  return sum;
}

}  // namespace

void Page::network() {
  heading(2, "The network", "network");
  for (const BusSummary& bus : model_.summary.buses) {
    const std::string_view name = buses_.name(bus.bus);
    heading(3, name);
    add("<p class=\"facts\">{}; {}; {}</p>\n", plural(bus.frames, "frame"),
        bus.protocol == Protocol::kRtex        ? "RTEX"
        : bus.protocol == Protocol::kDevicenet ? "DeviceNet"
                                               : "CAN, not recognised as DeviceNet",
        e(bus.recognised));
    if (!bus.facts.empty()) {
      begin_table({{"setting"}, {"value"}, {"known from"}});
      for (const Fact& fact : bus.facts)
        add("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td></tr>\n", e(fact.key), e(fact.value),
            e(basis_text(fact.basis)));
      end_table();
    }
    if (bus.protocol == Protocol::kRtex) ring(bus);
    if (bus.protocol == Protocol::kDevicenet) can(bus);
    statistics(bus, nullptr);
    for (const Histogram& entry : model_.histograms) {
      if (!(entry.bus == bus.bus)) continue;
      heading(4, entry.title);
      figure(histogram(entry, name), "The height is logarithmic: a single outlier shows beside thousands.");
    }
  }
}

// By place in the ring: missed updates, and CRC errors with what they suggest.
void Page::ring(const BusSummary& bus) {
  heading(4, "By place in the ring");
  begin_table({{"place", true},
               {"axis"},
               {"Update_Counter stuck", true},
               {"skipped", true},
               {"CRC errors", true},
               {"no response", true}});
  std::vector<std::size_t> hit;
  for (const NodeSummary& node : bus.nodes) {
    const std::uint64_t crc = times(model_, "RX101", node.node);
    if (crc != 0) hit.push_back(node.node.place + std::size_t{1});
    add("<tr><td class=\"number\">{}</td><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td>"
        "<td class=\"number\">{}</td><td class=\"number\">{}</td></tr>\n",
        node.node.place + 1, e(node_name(node.node)), times(model_, "RX201", node.node),
        times(model_, "RX202", node.node), crc, times(model_, "RX108", node.node));
  }
  end_table();
  std::sort(hit.begin(), hit.end());
  if (hit.empty()) {
    add("<p>No drive reported a CRC error.</p>\n");
  } else if (hit.size() == 1) {
    add("<p>Only place {} reported CRC errors: look at the cable and the connectors in front of this drive, and at "
        "noise "
        "there (SX-DSV02203 8-1-2).</p>\n",
        hit.front());
  } else if (hit.size() == bus.nodes.size()) {
    add("<p>Every place reported CRC errors: look at the cable from the master to the first drive, at the shields of "
        "the "
        "whole ring, and at noise (SX-DSV02203 8-1-2).</p>\n");
  } else if (hit.back() == bus.nodes.size() && hit.size() == bus.nodes.size() + 1 - hit.front()) {
    add("<p>CRC errors begin at place {} and go on to the end of the ring: look at the cable in front of place {} "
        "(SX-DSV02203 8-1-2).</p>\n",
        hit.front(), hit.front());
  } else {
    add("<p>{} of {} places reported CRC errors without a pattern: noise or bad shields are likelier than one cable "
        "(SX-DSV02203 8-1-2).</p>\n",
        hit.size(), bus.nodes.size());
  }
}

void Page::can(const BusSummary& bus) {
  const double seconds =
      static_cast<double>(std::max<DurationNs>(elapsed_ns(model_.capture.first_ns, model_.capture.last_ns), 1)) / 1e9;
  for (const BusLoad& load : model_.loads) {
    if (!(load.bus == bus.bus)) continue;
    heading(4, "Bus load");
    add("<p class=\"facts\">Bits of the frames without stuff bits; a capture does not show the bit "
        "rate.</p>\n");
    begin_table({{""}, {"kbit/s", true}, {"at 125 kbit/s", true}, {"at 250 kbit/s", true}, {"at 500 kbit/s", true}});
    const auto row = [&](std::string_view what, double kilobits) {
      add("<tr><td>{}</td><td class=\"number\">{:.1f}</td><td class=\"number\">{:.1f} %</td><td "
          "class=\"number\">{:.1f} "
          "%</td><td class=\"number\">{:.1f} %</td></tr>\n",
          what, kilobits, kilobits / 1.25, kilobits / 2.5, kilobits / 5);
    };
    row("mean over the capture", static_cast<double>(load.bits) / seconds / 1e3);
    row("fullest tenth of a second",
        static_cast<double>(load.peak_bits) / 1e3 * 1e9 / static_cast<double>(kLoadWindowNs));
    end_table();
  }
  heading(4, "Time-outs, duplicates and errors");
  begin_table({{"node"},
               {"polls unanswered", true},
               {"explicit unanswered", true},
               {"connection time-outs", true},
               {"duplicate MAC ID", true},
               {"error responses", true}});
  for (const NodeSummary& node : bus.nodes) {
    add("<tr><td>{}</td>", e(node_name(node.node)));
    for (const std::string_view id : {"DN205", "DN207", "DN204", "DN102", "DN401"})
      add("<td class=\"number\">{}</td>", times(model_, id, node.node));
    add("</tr>\n");
  }
  end_table();
  allocations(bus);
}

// How each node came on line and was allocated: MAC ID checks, allocations, releases, resets.
void Page::allocations(const BusSummary& bus) {
  std::vector<const Access*> shown;
  for (const Access& access : model_.accesses) {
    if (access.node.bus == bus.bus && access.kind == AccessKind::kConnection) shown.push_back(&access);
  }
  if (shown.empty()) return;
  heading(4, "How the nodes came on line");
  constexpr std::size_t kMost = 200;
  begin_table({{"time", true}, {"frame", true}, {"node"}, {"what"}});
  for (std::size_t i = 0; i < shown.size() && i < kMost; ++i) {
    const Access& access = *shown[i];
    add("<tr><td class=\"number\">{}</td><td class=\"number\">{}</td><td>{}</td><td>{}{}{}</td></tr>\n",
        at_time(model_, access.time_ns), access.frame, e(node_name(access.node)), e(access.what),
        access.refused         ? ", refused: "
        : access.value.empty() ? ""
                               : ": ",
        e(access.value));
  }
  end_table();
  if (shown.size() > kMost) add("<p>{} more are in report.json.</p>\n", shown.size() - kMost);
}

}  // namespace servotrace::report
