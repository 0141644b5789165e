// SPDX-License-Identifier: MIT
#include "decoder/render/dissection_text.hpp"

#include <fmt/format.h>

#include <iterator>

#include "decoder/render/node.hpp"
#include "decoder/render/value.hpp"

namespace servotrace {
namespace {

std::string node_name(const NodeRef& node, const Settings& settings) {
  return node_text(node, configured_name(settings, node));
}

void append_field(std::string& out, const Field& field, std::int64_t raw, Bytes bytes, const TextOptions& options) {
  const bool number = slot_of(field).width != 0;
  const std::string violation = violation_text(field, raw);
  if (field.reserved && violation.empty() && !options.reserved) return;
  out.append("    ").append(field.label).append(": ");
  out.append(number ? value_text(field, raw) : bytes_text(field, bytes));
  if (!violation.empty()) out.append("  <- ").append(violation);
  out += '\n';
  if (!options.explanations) return;
  const ValueName* const name = number ? find_value(field.values, raw) : nullptr;
  if (name != nullptr && !name->explanation.empty()) {
    fmt::format_to(std::back_inserter(out), "        {}\n", name->explanation);
  } else if (!field.explanation.empty()) {
    fmt::format_to(std::back_inserter(out), "        {}\n", field.explanation);
  }
  fmt::format_to(std::back_inserter(out), "        [{}]\n", field.section);
}

std::string derived_text(const Derived& entry) {
  return entry.field->kind == Kind::kText ? std::string(entry.text) : value_text(*entry.field, entry.value);
}

}  // namespace

std::string_view name_of(LinkKind kind) {
  switch (kind) {
    case LinkKind::kRequestIn:
      return "request in";
    case LinkKind::kAcceptedIn:
      return "accepted in";
    case LinkKind::kPreviousOfNode:
      return "previous of this node";
    case LinkKind::kFirstFragment:
      return "first fragment";
    case LinkKind::kReassembledFrom:
      return "reassembled from";
  }
  return "";
}

void append_text(std::string& out, const Dissection& dissection, const Settings& settings, const TextOptions& options) {
  const auto to = std::back_inserter(out);
  for (const Segment& segment : dissection.segments) {
    const std::string node = node_name(segment.node, settings);
    out.append("  ").append(node).append(node.empty() ? "" : ": ").append(segment.layout->title);
    if (segment.guessed) out += " (a guess)";
    out += segment.buffer == Buffer::kReassembled ? " (reassembled)\n" : "\n";
    for_each_field(*segment.layout, dissection.bytes(segment), [&](const Field& field, std::int64_t raw, Bytes bytes) {
      append_field(out, field, raw, bytes, options);
    });
  }
  for (const Derived& entry : dissection.derived) {
    const std::string node = node_name(entry.node, settings);
    fmt::format_to(to, "  [{}{}{}: {}]\n", node, node.empty() ? "" : ": ", entry.field->label, derived_text(entry));
  }
  for (const Link& link : dissection.links) {
    const std::string node = node_name(link.node, settings);
    fmt::format_to(to, "  [{}{}{} frame {}, {} before]\n", node, node.empty() ? "" : ": ", name_of(link.kind),
                   link.frame, duration_text(link.after_ns));
  }
  const std::uint32_t dropped =
      dissection.segments.dropped() + dissection.derived.dropped() + dissection.links.dropped();
  if (dropped != 0) fmt::format_to(to, "  [{} parts of this frame are not shown: too many]\n", dropped);
}

}  // namespace servotrace
