// SPDX-License-Identifier: MIT
// Findings: the list, and the policy that keeps it short. A condition that lasts is one finding with a start, an end
// and a count (an episode); what is found more than `max_findings` times at one owner is counted and not kept.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "decoder/findings/catalogue.hpp"
#include "decoder/findings/finding.hpp"
#include "decoder/link/raw_frame.hpp"

namespace servotrace {

// Who can have episodes: a channel of a node, a node, a bus, the capture. Sessions ask once and keep the number.
enum class OwnerId : std::uint32_t {};

// What a session reports.
struct Report {
  RuleId rule{};
  OwnerId owner{};
  std::array<std::int64_t, kMaxArguments> arguments = {};
  ByteRange where = {};
  std::array<std::uint64_t, 2> related = {};
  Basis basis = {};
  Cause cause = {};
  std::int64_t variant = 0;         // another variant (an error code) ends the episode and begins one of its own
  bool as_note = false;             // the catalogue lowers this occurrence to a note
  bool as_warning = false;          // the catalogue lowers this occurrence to a warning
  bool as_error = false;            // the catalogue raises this occurrence to an error
  std::optional<Actor> actor = {};  // who did it, where it is not the rule's actor
};

class Findings {
 public:
  // max_per_owner: findings kept for each rule and owner, at least 1.
  explicit Findings(std::uint32_t max_per_owner = 100);

  // The owner for `node`, made on first sight. Linear in the owners there are: keep the number.
  OwnerId owner(const NodeRef& node);
  // A node learns its name late (RTEX: Actual MAC-ID): later findings carry it. Earlier ones stay as they were said.
  void set_node(OwnerId owner, const NodeRef& node);
  // How the drive of this node was recognised: what a finding of a drive's rules (not of block DN) rests on where its
  // report names no basis.
  void set_drive_basis(OwnerId owner, const Basis& basis) {
    owners_[static_cast<std::size_t>(owner)].drive_basis = basis;
  }
  const NodeRef& node(OwnerId owner) const { return owners_[static_cast<std::size_t>(owner)].node; }

  // Adds a finding at `frame`, or extends the open episode of the same rule, owner and variant. Returns true where a
  // new finding was added.
  bool raise(const RawFrame& frame, const Report& report);
  // A later frame says more about the latest finding of `rule` at `owner`: as with its last frame and count, the
  // finding stays at its frame. Nothing happens where it was not kept.
  void amend(OwnerId owner, RuleId rule, const std::array<std::int64_t, kMaxArguments>& arguments, const Cause& cause);
  // An opportunity passed without the condition: its episode is over. Cheap where none is open.
  void calm(OwnerId owner, RuleId rule) {
    if (is_open(owner, rule)) close(owner, rule);
  }
  bool is_open(OwnerId owner, RuleId rule) const {
    const auto index = static_cast<std::size_t>(rule);
    return (owners_[static_cast<std::size_t>(owner)].open[index / 64] >> (index % 64) & 1U) != 0;
  }
  // The frame of the latest occurrence of `rule` at `owner`, 0 where there was none. For causes.
  std::uint64_t last_frame(OwnerId owner, RuleId rule) const;

  // A rule had an opportunity (statistics of what was checked).
  void checked(RuleId rule, std::uint64_t times = 1) { checked_[static_cast<std::size_t>(rule)] += times; }
  std::uint64_t times_checked(RuleId rule) const { return checked_[static_cast<std::size_t>(rule)]; }
  // Occurrences as findings (episodes), those above max_per_owner included.
  std::uint64_t total(RuleId rule) const { return total_[static_cast<std::size_t>(rule)]; }

  std::span<const Finding> all() const { return findings_; }
  // What was added since the last call of mark(): the pipeline marks at the start of every push.
  std::span<const Finding> fresh() const { return std::span(findings_).subspan(mark_); }
  void mark() { mark_ = findings_.size(); }
  // For what only the end of a capture knows (drop totals lower a severity).
  std::span<Finding> mutable_all() { return findings_; }

 private:
  struct RuleState {
    RuleId rule{};
    std::uint32_t finding = kNotKept;
    std::uint32_t raised = 0;
    std::int64_t variant = 0;
    std::uint64_t last_frame = 0;
  };
  struct Owner {
    NodeRef node;
    Basis drive_basis;
    std::array<std::uint64_t, (kRuleCount + 63) / 64> open = {};
    std::vector<RuleState> states;
  };
  static constexpr std::uint32_t kNotKept = 0xFFFFFFFFU;
  static constexpr std::size_t kMaxStates = 4 * kRuleCount + 64;

  void close(OwnerId owner, RuleId rule);
  static RuleState& state(Owner& owner, const Report& report);

  std::uint32_t max_per_owner_;
  std::vector<Owner> owners_;
  std::vector<Finding> findings_;
  std::size_t mark_ = 0;
  std::array<std::uint64_t, kRuleCount> checked_ = {};
  std::array<std::uint64_t, kRuleCount> total_ = {};
};

}  // namespace servotrace
