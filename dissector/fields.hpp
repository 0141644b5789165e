// SPDX-License-Identifier: GPL-2.0-or-later
// Wireshark's fields, made from the rows of all layouts and of the catalogue: a new row there needs no line here.
#pragma once

#include <string_view>

#include "decoder/core/layout.hpp"
#include "decoder/findings/catalogue.hpp"
#include "decoder/pipeline/dissection.hpp"
#include "dissector/ws.hpp"

namespace servotrace::plugin {

// Registers protocols, fields, subtrees and expert items. Once, at start-up.
void register_fields();

// A protocol by the first part of its filter names ("rtex", "dnet", a profile's); -1 where there is none.
int protocol_id(std::string_view protocol);
int servotrace_protocol_id();
// Names for the protocol column.
const char* protocol_column(std::string_view protocol);

// Graphs need a field of each axis and node: `rtex.axis3.actual_position`, `ns310.node5.current_position` for every
// process value. Its values are numbers in the field's unit.
struct Signal;
struct AxisSignal {
  int field = -1;       // -1: none, the MAC ID is out of range
  bool scaled = false;  // a floating-point field: the row has a scale
};
// `signal` may be nullptr: the field is no process value.
AxisSignal axis_signal(const Signal* signal, std::int16_t mac_id);

// The fields of a layout in the order of its rows; nullptr for a layout all_layouts() does not list.
struct LayoutFields {
  const int* fields = nullptr;
  const Signal* const* signals = nullptr;
  int subtree = -1;
};
LayoutFields fields_of(const Layout* layout);

struct DerivedIds {
  int field = -1;  // -1: all_derived() does not list it
  const Signal* signal = nullptr;
};
DerivedIds ids_of(const Derived& derived);

// Links between frames, a set for each of the protocols that have nodes.
struct LinkFields {
  int request_in = -1;        // this frame answers that one
  int response_in = -1;       // that frame answers this one
  int response_time = -1;     // from the request to this answer
  int accepted_command = -1;  // this frame accepts the command of that one
  int accepted_in = -1;
  int previous_in = -1;  // of the same node and direction
  int next_in = -1;
  int first_fragment = -1;
  int fragment = -1;  // an earlier fragment of the message this frame completes
  int reassembled_in = -1;
};
const LinkFields& link_fields(Protocol protocol);

// Of findings (protocol `servotrace`).
struct FindingFields {
  int rule = -1;
  int slug = -1;
  int severity = -1;
  int actor = -1;
  int title = -1;
  int message = -1;
  int node = -1;
  int mac_id = -1;
  int section = -1;
  int why = -1;
  int fix = -1;
  int count = -1;
  int last_frame = -1;
  int related = -1;
  int cause = -1;
  int cause_frame = -1;
  int basis = -1;
  int basis_frame = -1;
};
const FindingFields& finding_fields();
expert_field* expert_of(RuleId rule, Severity severity);

struct Subtrees {
  int protocol = -1;
  int node = -1;
  int findings = -1;
  int finding = -1;
};
const Subtrees& subtrees();

}  // namespace servotrace::plugin
