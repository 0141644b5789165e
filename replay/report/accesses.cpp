// SPDX-License-Identifier: MIT
#include "replay/report/accesses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "decoder/core/slot.hpp"
#include "decoder/devicenet/derived.hpp"
#include "decoder/profiles/nsk_esb/derived.hpp"
#include "decoder/render/value.hpp"
#include "decoder/rtex/layouts.hpp"
#include "replay/report/node_key.hpp"

namespace servotrace::report {
namespace {

constexpr std::size_t kMaxValue = 200;       // characters of a value
constexpr std::ptrdiff_t kKeptFirst = 1000;  // transactions never left out

std::string text_of(const Field& field, Bytes bytes) {
  if (field.kind == Kind::kBytes || field.kind == Kind::kText) return bytes_text(field, bytes_of(field, bytes));
  return value_text(field, read(slot_of(field), bytes));
}

// All fields that are no padding: "Vendor ID 44, ..." with names where there are several.
std::string values_of(const Layout& layout, Bytes bytes) {
  std::size_t count = 0;
  for (const Field& field : layout.fields) count += field.reserved ? 0 : 1;
  std::string text;
  for (const Field& field : layout.fields) {
    if (field.reserved) continue;
    const std::string value = text_of(field, bytes);
    text += fmt::format("{}{}", text.empty() ? "" : ", ", count > 1 ? fmt::format("{} {}", field.label, value) : value);
    if (text.size() > kMaxValue) {
      text.resize(kMaxValue);
      text += "...";
      break;
    }
  }
  return text;
}

std::string_view derived_text(const Dissection& dissection, const Field& field) {
  for (const Derived& derived : dissection.derived) {
    if (derived.field == &field) return derived.text;
  }
  return {};
}

std::string unquoted(std::string text) {
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return text;
}

}  // namespace

std::string_view name_of(AccessKind kind) {
  constexpr std::string_view kNames[] = {"identity", "read", "write", "program", "alarm", "connection"};
  return kNames[static_cast<std::size_t>(kind)];
}

AccessLog::Node& AccessLog::node_of(const NodeRef& node) { return nodes_[node_key(node)]; }

void AccessLog::note(Access access) {
  Node& node = node_of(access.node);
  if (access.kind != AccessKind::kConnection && access.kind != AccessKind::kProgram) {
    std::string& known = node.values[access.what];
    access.before = known;
    if (!access.refused) known = access.value;
  }
  if (accesses_.size() >= kMaxAccesses) {  // the first ones tell the settings, the latest what came before a fault
    const auto first = accesses_.begin() + kKeptFirst;
    const auto last = first + (static_cast<std::ptrdiff_t>(kMaxAccesses) - kKeptFirst) / 2;
    dropped_ += static_cast<std::uint64_t>(last - first);
    accesses_.erase(first, last);
  }
  accesses_.push_back(std::move(access));
}

void AccessLog::add(const RawFrame& frame, const Dissection& dissection) {
  if (dissection.protocol == Protocol::kRtex && dissection.direction == Direction::kResponse)
    add_rtex(frame, dissection);
  if (dissection.protocol == Protocol::kDevicenet) add_devicenet(frame, dissection);
}

// Answers to parameter (SX-DSV02203 6-7), system ID (6-4) and alarm commands (6-6): the echo in bytes 8-11, the value
// in 12-15. They stand as long as the command is held and are noted once.
void AccessLog::add_rtex(const RawFrame& frame, const Dissection& dissection) {
  const Segment* echo = nullptr;
  const auto close = [&](const Segment& of, std::string open) {
    Node& node = node_of(of.node);
    if (node.open == open) return false;
    entangled_ = entangled_ || node.opened_in == frame.number;
    node.opened_in = frame.number;
    open_ += open.empty() ? 0 : 1;
    open_ -= node.open.empty() ? 0 : 1;
    node.open = std::move(open);
    return !node.open.empty();
  };
  for (const Segment& segment : dissection.segments) {
    if (segment.direction != Direction::kResponse || segment.node.mac_id == kNoMacId) continue;
    const Layout* layout = segment.layout;
    if (rtex::is_response_header(*layout)) {
      echo = nullptr;
      const bool standard = read(slot(rtex::kResponse, "non_cyclic_command_echo"), dissection.bytes(segment)) == 0;
      if (standard && open_ != 0) close(segment, {});
      continue;
    }
    if (layout == &rtex::kParameterEcho || layout == &rtex::kSystemIdEcho || layout == &rtex::kAlarmEcho) {
      echo = &segment;
      continue;
    }
    if (echo == nullptr) continue;
    // The word behind the echo is its value; what follows in a wide block is the sub channel's.
    const Segment* const before = std::exchange(echo, nullptr);
    if (!(before->node.bus == segment.node.bus) || before->node.mac_id != segment.node.mac_id) continue;
    const Bytes asked = dissection.bytes(*before);
    const Bytes given = dissection.bytes(segment);
    const Field* busy = before->layout->find("busy");
    const Field* err = before->layout->find("err");
    if (busy == nullptr || read(slot_of(*busy), asked) != 0) continue;
    const Field& type = *before->layout->find("type_code_echo");
    const std::int64_t type_code = read(slot_of(type), asked);
    Access access{.kind = AccessKind::kRead,
                  .time_ns = frame.time_ns,
                  .frame = frame.number,
                  .node = segment.node,
                  .refused = err != nullptr && read(slot_of(*err), asked) != 0};
    const bool is_value = type_code == rtex::kParameterRead || type_code == rtex::kParameterWrite;
    if (is_value && before->layout == &rtex::kParameterEcho) {
      const std::int64_t index = read(slot(rtex::kParameterEcho, "parameter_echo"), asked);
      const ValueName* name = find_value(rtex::kParameterNames, index);
      access.what = name != nullptr ? std::string(name->name) : fmt::format("Pr{}.{:02}", index >> 8, index & 0xFF);
      access.value = values_of(*layout, given);
      if (type_code == rtex::kParameterWrite) access.kind = AccessKind::kWrite;
    } else if (layout == &rtex::kCharacters[0] && before->layout == &rtex::kSystemIdEcho) {
      const std::int64_t index = read(slot(rtex::kSystemIdEcho, "index_echo"), asked);
      access.kind = AccessKind::kIdentity;
      const ValueName* name = find_value(rtex::kSystemIdTypes, type_code);
      access.what = name != nullptr ? std::string(name->name) : value_text(type, type_code);
      std::string piece = unquoted(values_of(*layout, given));
      piece.resize(std::min(piece.find("\\x00"), piece.size()));  // NUL ends the string
      // Four characters an index: the pieces of one string are put together (6-4).
      Node& node = node_of(segment.node);
      const std::string place = fmt::format("{}#{}", access.what, index);
      if (!close(segment, place)) continue;
      if (index != 0 && node.string_key == access.what && !accesses_.empty()) {
        const auto last = std::find_if(accesses_.rbegin(), accesses_.rend(), [&](const Access& entry) {
          return entry.what == access.what && node_key(entry.node) == node_key(segment.node);
        });
        if (last != accesses_.rend()) {
          last->value += piece;
          node.values[access.what] = last->value;
          continue;
        }
      }
      node.string_key = access.what;
      access.value = piece;
      note(std::move(access));
      continue;
    } else if (layout == &rtex::kAlarmCode && before->layout == &rtex::kAlarmEcho) {
      const std::int64_t index = read(slot(rtex::kAlarmEcho, "index_echo"), asked);
      access.kind = AccessKind::kAlarm;
      access.what = type_code != rtex::kAlarmRead ? value_text(type, type_code)
                    : index == 0                  ? "present alarm"
                                                  : fmt::format("alarm history {}", index);
      access.value = values_of(*layout, given);
    } else {
      continue;
    }
    if (close(segment, fmt::format("{}#{}#{}", access.what, type_code, access.value))) note(std::move(access));
  }
}

void AccessLog::add_devicenet(const RawFrame& frame, const Dissection& dissection) {
  NodeRef node;
  node.mac_id = kNoMacId;
  for (const Derived& derived : dissection.derived) {
    if (derived.node.mac_id != kNoMacId) node = derived.node;
  }
  if (node.mac_id == kNoMacId) return;
  if (const std::string_view message = derived_text(dissection, devicenet::kMessageField);
      message == "Duplicate MAC ID check") {
    note({.kind = AccessKind::kConnection,
          .time_ns = frame.time_ns,
          .frame = frame.number,
          .node = node,
          .what = std::string(message)});
    return;
  }
  if (const std::string_view service = derived_text(dissection, devicenet::kServiceNameField); !service.empty()) {
    add_explicit(frame, dissection, node, service);
    return;
  }
  // The parameter handshake of the ESB (5.2): "read PG: 0.100", "write VG45.0: successful".
  const std::string_view transaction = derived_text(dissection, esb::kTransaction);
  const std::size_t colon = transaction.find(": ");
  if (colon == std::string_view::npos || dissection.direction != Direction::kResponse) return;
  const bool write = transaction.starts_with("write ");
  const std::string_view asked = transaction.substr(transaction.find(' ') + 1, colon - transaction.find(' ') - 1);
  const std::string_view result = transaction.substr(colon + 2);
  const std::size_t letters = write ? std::min(asked.find_first_of("0123456789-+"), asked.size()) : asked.size();
  const bool ok = !write || result == "successful";
  const std::string open = fmt::format("{}", transaction);
  Node& state = node_of(node);
  if (state.open == open) return;  // PRM_ACK stands for several polls
  state.open = open;
  // Between 500 or 501 and 502 numbers are lines of a channel's program, no parameters (5.3.1).
  const std::string_view what = asked.substr(0, letters);
  if (ok && (what == "CH" || what == "TC")) state.in_program = true;
  const bool in_program = state.in_program;
  if (ok && what.starts_with("End of reading")) state.in_program = false;
  note({.kind = in_program ? AccessKind::kProgram
                : write    ? AccessKind::kWrite
                           : AccessKind::kRead,
        .time_ns = frame.time_ns,
        .frame = frame.number,
        .node = node,
        .what = std::string(what),
        .value = std::string(write ? (ok ? asked.substr(letters) : result) : result),
        .refused = !ok});
}

void AccessLog::add_explicit(const RawFrame& frame, const Dissection& dissection, const NodeRef& node,
                             std::string_view service) {
  const std::string_view object = derived_text(dissection, devicenet::kObjectNameField);
  const std::string_view attribute = derived_text(dissection, devicenet::kAttributeNameField);
  std::string value;
  bool refused = false;
  for (const Segment& segment : dissection.segments) {
    if (segment.layout->title == attribute) value = values_of(*segment.layout, dissection.bytes(segment));
    if (segment.layout->find("general_status") != nullptr) {
      refused = true;
      value = values_of(*segment.layout, dissection.bytes(segment));
    }
  }
  const bool sets = service.starts_with("Set_");
  if (dissection.direction == Direction::kCommand) {
    if (sets) node_of(node).written = value;
    return;
  }
  if (dissection.direction != Direction::kResponse) return;
  Access access{.kind = AccessKind::kRead,
                .time_ns = frame.time_ns,
                .frame = frame.number,
                .node = node,
                .what = attribute.empty() ? fmt::format("{}", object) : fmt::format("{}: {}", object, attribute),
                .value = std::move(value),
                .refused = refused};
  if (attribute.empty() || (!sets && !service.starts_with("Get_"))) {
    access.kind = AccessKind::kConnection;
    access.what = fmt::format("{}{}{}", service, object.empty() ? "" : ", ", object);
  } else if (sets) {
    access.kind = AccessKind::kWrite;
    if (!refused) access.value = std::exchange(node_of(node).written, {});
  } else if (object.starts_with("Identity")) {
    access.kind = AccessKind::kIdentity;
  }
  note(std::move(access));
}

}  // namespace servotrace::report
