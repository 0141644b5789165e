// SPDX-License-Identifier: MIT
// What the sessions of all drive profiles share: whose they are, and how they add segments and raise findings. A
// guessed drive (`decode_only`) adds segments marked as guessed and raises nothing.
#pragma once

#include <initializer_list>

#include "decoder/profiles/phase.hpp"
#include "decoder/profiles/profile.hpp"

namespace servotrace {

class DriveBase : public DriveSession {
 public:
  DriveBase(const Settings& settings, const NodeRef& node, OwnerId owner, bool decode_only)
      : limits_(settings.limits), node_(node), owner_(owner), decode_only_(decode_only) {}

 protected:
  // Lays `layout` over `length` bytes of `message` from `offset` on (0: the layout's size). Nothing where nobody looks.
  void add(const Context& context, const Message& message, const Layout& layout, std::uint32_t offset,
           Direction direction, std::uint32_t length = 0) const {
    if (context.dissection == nullptr) return;
    context.dissection->add({.layout = &layout,
                             .offset = message.offset + offset,
                             .length = length == 0 ? layout.size : length,
                             .buffer = message.buffer,
                             .node = node_,
                             .direction = direction,
                             .guessed = decode_only_});
  }
  void add(const Context& context, const Field& field, std::string_view protocol, std::int64_t value,
           std::string_view text = {}) const {
    if (context.dissection == nullptr) return;
    context.dissection->derived.push_back(
        {.field = &field, .protocol = protocol, .value = value, .text = text, .node = node_});
  }
  void link(const Context& context, LinkKind kind, std::uint64_t frame, TimeNs time_ns) const {
    if (context.dissection == nullptr || frame == 0) return;
    context.dissection->links.push_back(
        {.kind = kind, .frame = frame, .after_ns = elapsed_ns(time_ns, context.frame.time_ns), .node = node_});
  }

  // True where a new finding was added. A guessed drive raises nothing.
  bool raise(const Context& context, Report report) const {
    if (decode_only_) return false;
    report.owner = owner_;
    return context.findings.raise(context.frame, report);
  }
  // `rule` had an opportunity; where it is not found its episode is over.
  void judge(const Context& context, bool found, const Report& report) const {
    if (decode_only_) return;
    context.findings.checked(report.rule);
    if (found) {
      raise(context, report);
    } else {
      context.findings.calm(owner_, report.rule);
    }
  }
  // `rule` had an opportunity and was not found.
  void passed(const Context& context, RuleId rule) const {
    if (decode_only_) return;
    context.findings.checked(rule);
    context.findings.calm(owner_, rule);
  }
  void checked(const Context& context, RuleId rule) const {
    if (!decode_only_) context.findings.checked(rule);
  }

  // The latest finding of this node by one of `rules` that still held at `since_frame` or later: what a report of the
  // drive answers. Called on reports only, which are rare.
  Cause cause_among(const Context& context, std::initializer_list<RuleId> rules, std::uint64_t since_frame) const {
    if (decode_only_) return {};
    const std::span<const Finding> all = context.findings.all();
    Cause best;
    std::uint64_t best_frame = 0;
    for (const RuleId rule : rules) {
      const std::uint64_t last = context.findings.last_frame(owner_, rule);
      if (last == 0 || last < since_frame || last < best_frame) continue;
      for (std::size_t i = all.size(); i-- > 0;) {
        if (all[i].rule != rule || !(all[i].node == context.findings.node(owner_))) continue;
        if (last > best_frame) {
          best = {rule, all[i].frame};
          best_frame = last;
        }
        break;
      }
    }
    return best;
  }

  bool decode_only() const { return decode_only_; }
  const NodeRef& node() const { return node_; }
  const Limits& limits() const { return limits_; }

 private:
  Limits limits_;
  NodeRef node_;
  OwnerId owner_;
  bool decode_only_;
};

// The bytes of the frame that carry bytes [offset, offset + length) of a message that is whole in this frame; of a
// message put together from fragments, all of the message's bytes in this frame.
inline ByteRange bytes_in_frame(const Message& message, std::uint32_t offset, std::uint32_t length) {
  if (message.buffer != Buffer::kFrame) return message.in_frame;
  return {message.in_frame.offset + offset, length};
}

}  // namespace servotrace
