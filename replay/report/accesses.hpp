// SPDX-License-Identifier: MIT
// What was asked of a node and answered, one line a transaction: parameters read and written (with the value before,
// where the capture showed it), identity, alarm history, and how its connections came about.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "decoder/link/raw_frame.hpp"
#include "decoder/pipeline/dissection.hpp"

namespace servotrace::report {

enum class AccessKind : std::uint8_t { kIdentity, kRead, kWrite, kProgram, kAlarm, kConnection };

struct Access {
  AccessKind kind = AccessKind::kRead;
  TimeNs time_ns = 0;
  std::uint64_t frame = 0;  // of the answer
  NodeRef node;
  std::string what;    // "Pr0.14", "Identity: Vendor ID", "alarm history 1", "Allocate_Master/Slave_Connection_Set"
  std::string before;  // the value last seen; empty: the capture did not show it
  std::string value;   // after it
  bool refused = false;
  bool changes() const { return kind == AccessKind::kWrite && !refused && !before.empty() && before != value; }
};

// "alarms", "identity", ...: the word of report.json.
std::string_view name_of(AccessKind kind);

inline constexpr std::size_t kMaxAccesses = 5000;

class AccessLog {
 public:
  void add(const RawFrame& frame, const Dissection& dissection);
  // In the order of the file.
  std::vector<Access> take() { return std::move(accesses_); }
  std::uint64_t dropped() const { return dropped_; }
  // Two answers in one record took turns at a node: each record has to be seen.
  bool are_entangled() const { return entangled_; }

 private:
  struct Node {
    std::string open;             // RTEX: the answer that stands, so that it is noted once
    std::uint64_t opened_in = 0;  // the frame that brought it, or ended it
    std::string written;          // DeviceNet: the value of a Set on its way
    std::string string_key;
    bool in_program = false;                    // ESB
    std::map<std::string, std::string> values;  // by what
  };

  void add_rtex(const RawFrame& frame, const Dissection& dissection);
  void add_devicenet(const RawFrame& frame, const Dissection& dissection);
  void add_explicit(const RawFrame& frame, const Dissection& dissection, const NodeRef& node, std::string_view service);
  void note(Access access);
  Node& node_of(const NodeRef& node);

  std::map<std::uint64_t, Node> nodes_;
  std::size_t open_ = 0;  // nodes of rings with an answer that stands
  std::vector<Access> accesses_;
  std::uint64_t dropped_ = 0;
  bool entangled_ = false;
};

}  // namespace servotrace::report
