// SPDX-License-Identifier: GPL-2.0-or-later
#include "dissector/fields.hpp"

#include <array>
#include <cctype>
#include <deque>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "decoder/pipeline/registry.hpp"
#include "decoder/profiles/profile.hpp"
#include "decoder/profiles/profiles.hpp"

namespace servotrace::plugin {

// The fields of one process value, one an axis or node.
struct Signal {
  std::string_view protocol;
  std::string_view key;
  const Field* row = nullptr;
  bool scaled = false;
  std::deque<int> fields;
};

namespace {

constexpr std::size_t kAxes = 32;   // MAC IDs of a ring (SX-DSV02203 4-2-2)
constexpr std::size_t kNodes = 64;  // MAC IDs of a DeviceNet bus

// Wireshark keeps the pointers it is given, so everything here lives until the program ends.
struct Texts {
  std::deque<std::string> kept;
  std::unordered_map<std::string_view, const char*> known;
  const char* keep(std::string_view text) {
    const auto found = known.find(text);
    if (found != known.end()) return found->second;
    const std::string& copy = kept.emplace_back(text);
    known.emplace(copy, copy.c_str());
    return copy.c_str();
  }
};

struct ProtocolRow {
  std::string_view name;  // first part of the filter names
  int id = -1;
  const char* column = "";
  LinkFields links;
};

struct DerivedPlace {
  const Field* row = nullptr;
  std::string_view protocol;
  DerivedIds ids;
};

struct LayoutPlace {
  std::vector<int> fields;
  std::vector<const Signal*> signals;
  int subtree = -1;
};

struct Registry {
  Texts texts;
  std::deque<ProtocolRow> protocols;
  int servotrace = -1;
  std::unordered_map<const Layout*, LayoutPlace> layouts;
  std::deque<DerivedPlace> derived;
  std::unordered_multimap<const Field*, const DerivedPlace*> derived_of;
  std::deque<Signal> signals;
  FindingFields finding;
  Subtrees subtrees;
  std::deque<hf_register_info> rows;
  std::deque<std::vector<value_string>> names;
  std::deque<std::vector<val64_string>> wide_names;
  std::deque<true_false_string> switches;
  expert_field experts[kRuleCount][3];
  std::deque<ei_register_info> expert_rows;
};

// Never destroyed: Wireshark may look at its pointers while the program ends.
Registry& registry() {
  static Registry* const instance = new Registry;
  return *instance;
}

void add_field(int protocol, int* id, const char* name, const char* filter, enum ftenum type, int display,
               const void* strings, std::uint64_t mask, const char* blurb) {
  hf_register_info& row = registry().rows.emplace_back();
  row.p_id = id;
  row.hfinfo.name = name;
  row.hfinfo.abbrev = filter;
  row.hfinfo.type = type;
  row.hfinfo.display = display;
  row.hfinfo.strings = strings;
  row.hfinfo.bitmask = mask;
  row.hfinfo.blurb = blurb;
  HFILL_INIT(row);
  proto_register_field_array(protocol, &row, 1);
}

enum ftenum unsigned_type(std::size_t bytes) {
  static constexpr enum ftenum kTypes[] = {FT_UINT8,  FT_UINT8,  FT_UINT16, FT_UINT24, FT_UINT32,
                                           FT_UINT40, FT_UINT48, FT_UINT56, FT_UINT64};
  return kTypes[bytes];
}
enum ftenum signed_type(std::size_t bytes) {
  static constexpr enum ftenum kTypes[] = {FT_INT8,  FT_INT8,  FT_INT16, FT_INT24, FT_INT32,
                                           FT_INT40, FT_INT48, FT_INT56, FT_INT64};
  return kTypes[bytes];
}

// Value names in the form Wireshark wants them, or nullptr.
const void* value_names(const Field& field, bool wide) {
  Registry& all = registry();
  if (field.values.empty()) return nullptr;
  if (field.kind == Kind::kBool) {
    const ValueName* const off = find_value(field.values, 0);
    const ValueName* const on = find_value(field.values, 1);
    return &all.switches.emplace_back(true_false_string{on == nullptr ? "1" : all.texts.keep(on->name),
                                                        off == nullptr ? "0" : all.texts.keep(off->name)});
  }
  if (wide) {
    std::vector<val64_string>& names = all.wide_names.emplace_back();
    for (const ValueName& value : field.values)
      names.push_back({static_cast<std::uint64_t>(value.value), all.texts.keep(value.name)});
    names.push_back({0, nullptr});
    return names.data();
  }
  std::vector<value_string>& names = all.names.emplace_back();
  for (const ValueName& value : field.values)
    names.push_back({static_cast<std::uint32_t>(value.value), all.texts.keep(value.name)});
  names.push_back({0, nullptr});
  return names.data();
}

// What stands behind a field in Wireshark's field list: section, unit, explanation.
const char* blurb_of(const Field& field) {
  std::string text;
  const std::string_view unit = symbol(field.unit);
  if (!unit.empty()) {
    text += "[";
    if (field.scale.numerator != 1) text += std::to_string(field.scale.numerator) + " ";
    if (field.scale.denominator != 1) text += "1/" + std::to_string(field.scale.denominator) + " ";
    text += unit;
    text += "] ";
  }
  if (!field.explanation.empty()) {
    text += field.explanation;
    text += " ";
  }
  text += "(";
  text += field.section;
  text += ")";
  return registry().texts.keep(text);
}

void add_row(int protocol, int* id, const Field& field, const char* filter, bool derived) {
  Texts& texts = registry().texts;
  const char* const name = texts.keep(field.label);
  const char* const blurb = blurb_of(field);
  switch (field.kind) {
    case Kind::kBytes:
      add_field(protocol, id, name, filter, FT_BYTES, BASE_NONE, nullptr, 0, blurb);
      return;
    case Kind::kText:
      add_field(protocol, id, name, filter, derived ? FT_STRING : FT_STRINGZPAD, BASE_NONE, nullptr, 0, blurb);
      return;
    default:
      break;
  }
  const std::size_t bytes = derived && field.width == 0 ? 8 : field.byte_count();
  const bool wide = bytes > 4;
  const bool whole = derived || (field.first_bit % 8U == 0 && field.width == bytes * 8);
  const std::uint64_t ones = field.width >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << field.width) - 1;
  const std::uint64_t mask = whole ? 0 : ones << (field.first_bit % 8U);
  const void* const names = value_names(field, wide);
  if (field.kind == Kind::kBool) {
    add_field(protocol, id, name, filter, FT_BOOLEAN, mask == 0 ? int{BASE_NONE} : static_cast<int>(bytes * 8), names,
              mask, blurb);
    return;
  }
  const bool is_signed = field.kind == Kind::kSigned;
  int display = field.base == Base::kHex && !is_signed ? int{BASE_HEX} : int{BASE_DEC};
  if (names != nullptr && wide) display |= BASE_VAL64_STRING;
  add_field(protocol, id, name, filter, is_signed ? signed_type(bytes) : unsigned_type(bytes), display, names, mask,
            blurb);
}

const char* filter_name(std::string_view protocol, std::string_view layout, std::string_view field) {
  std::string text(protocol);
  if (!layout.empty()) {
    text += '.';
    text += layout;
  }
  text += '.';
  text += field;
  return registry().texts.keep(text);
}

ProtocolRow* find_protocol(std::string_view name) {
  for (ProtocolRow& row : registry().protocols) {
    if (row.name == name) return &row;
  }
  return nullptr;
}

void add_protocol(std::string_view name, const char* title, const char* column) {
  ProtocolRow& row = registry().protocols.emplace_back();
  row.name = name;
  row.column = column;
  row.id = proto_register_protocol(title, column, registry().texts.keep(name));
}

void register_protocols() {
  Texts& texts = registry().texts;
  add_protocol("rtex", "Realtime Express (RTEX)", "RTEX");
  add_protocol("dnet", "DeviceNet drives", "DNET");
  for (const DriveProfile* profile : profiles()) {
    for (const Layout* layout : profile->layouts) {
      if (find_protocol(layout->protocol) != nullptr) continue;
      std::string column(layout->protocol);
      for (char& c : column) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
      add_protocol(layout->protocol, texts.keep(profile->title), texts.keep(column));
    }
  }
  registry().servotrace = proto_register_protocol("servotrace findings", "servotrace", "servotrace");
}

void register_layouts() {
  Registry& all = registry();
  for (const Layout* layout : all_layouts()) {
    const ProtocolRow* const protocol = find_protocol(layout->protocol);
    if (protocol == nullptr || all.layouts.count(layout) != 0) continue;
    LayoutPlace& place = all.layouts[layout];
    place.fields.assign(layout->fields.size(), -1);
    place.signals.assign(layout->fields.size(), nullptr);
    for (std::size_t i = 0; i < layout->fields.size(); ++i) {
      const Field& field = layout->fields[i];
      add_row(protocol->id, &place.fields[i], field, filter_name(layout->protocol, layout->key, field.key), false);
    }
    int* const places[] = {&place.subtree};
    proto_register_subtree_array(places, 1);
  }
  for (const DerivedField& row : all_derived()) {
    const ProtocolRow* const protocol = find_protocol(row.protocol);
    if (protocol == nullptr) continue;
    DerivedPlace& place = all.derived.emplace_back(DerivedPlace{row.field, protocol->name, {}});
    all.derived_of.emplace(row.field, &place);
    add_row(protocol->id, &place.ids.field, *row.field, filter_name(row.protocol, {}, row.field->key), true);
  }
}

void register_signals() {
  Registry& all = registry();
  const auto collect = [&all](std::string_view of, const Field& field) {
    const bool is_number = field.kind == Kind::kSigned || field.kind == Kind::kUnsigned;
    if (field.role != Role::kSignal || !is_number || find_protocol(of) == nullptr) return;
    for (Signal& signal : all.signals) {
      if (signal.protocol != of || signal.key != field.key) continue;
      signal.scaled = signal.scaled || field.scale != Ratio{};
      return;
    }
    Signal& signal = all.signals.emplace_back();
    signal.protocol = find_protocol(of)->name;
    signal.key = field.key;
    signal.row = &field;
    signal.scaled = field.scale != Ratio{};
  };
  for (const Layout* layout : all_layouts()) {
    for (const Field& field : layout->fields) collect(layout->protocol, field);
  }
  for (const DerivedField& row : all_derived()) collect(row.protocol, *row.field);
  for (Signal& signal : all.signals) {
    const bool is_ring = signal.protocol == "rtex";
    const std::string word = is_ring ? "axis" : "node";
    for (std::size_t node = 0; node < (is_ring ? kAxes : kNodes); ++node) {
      const std::string label = std::string(signal.row->label) + ", " + word + " " + std::to_string(node);
      add_field(find_protocol(signal.protocol)->id, &signal.fields.emplace_back(-1), all.texts.keep(label),
                filter_name(signal.protocol, word + std::to_string(node), signal.key),
                signal.scaled ? FT_DOUBLE : FT_INT64, signal.scaled ? int{BASE_NONE} : int{BASE_DEC}, nullptr, 0,
                blurb_of(*signal.row));
    }
  }
}

const Signal* find_signal(std::string_view protocol, const Field& field) {
  if (field.role != Role::kSignal) return nullptr;
  for (const Signal& signal : registry().signals) {
    if (signal.protocol == protocol && signal.key == field.key) return &signal;
  }
  return nullptr;
}

void place_signals() {
  for (auto& [layout, place] : registry().layouts) {
    for (std::size_t i = 0; i < place.signals.size(); ++i)
      place.signals[i] = find_signal(layout->protocol, layout->fields[i]);
  }
  for (DerivedPlace& place : registry().derived) place.ids.signal = find_signal(place.protocol, *place.row);
}

void register_links(ProtocolRow& protocol) {
  Texts& texts = registry().texts;
  const auto add = [&](int& id, const char* name, const char* key, ft_framenum_type_t kind, const char* blurb) {
    add_field(protocol.id, &id, name, filter_name(protocol.name, {}, key), FT_FRAMENUM, BASE_NONE,
              kind == FT_FRAMENUM_NONE ? nullptr : FRAMENUM_TYPE(kind), 0, texts.keep(blurb));
  };
  LinkFields& links = protocol.links;
  add(links.request_in, "Request in", "request_in", FT_FRAMENUM_REQUEST, "This frame answers the one named here");
  add(links.response_in, "Response in", "response_in", FT_FRAMENUM_RESPONSE, "The frame that answers this one");
  add_field(protocol.id, &links.response_time, "Response time", filter_name(protocol.name, {}, "response_time"),
            FT_RELATIVE_TIME, BASE_NONE, nullptr, 0, "From the request to this answer");
  add(links.accepted_command, "Accepts the command in", "accepted_command", FT_FRAMENUM_REQUEST,
      "The command whose acceptance this frame shows was first sent in the frame named here");
  add(links.accepted_in, "Accepted in", "accepted_in", FT_FRAMENUM_ACK,
      "The frame whose response first echoes this command");
  add(links.previous_in, "Previous frame of this node", "previous_in", FT_FRAMENUM_NONE,
      "The frame before this one of the same node, direction and kind of message");
  add(links.next_in, "Next frame of this node", "next_in", FT_FRAMENUM_NONE,
      "The frame after this one of the same node, direction and kind of message");
  add(links.first_fragment, "First fragment in", "first_fragment", FT_FRAMENUM_NONE,
      "The frame that holds the first fragment of this message");
  add(links.fragment, "Fragment in", "fragment", FT_FRAMENUM_NONE,
      "A frame that holds an earlier fragment of this message");
  add(links.reassembled_in, "Reassembled in", "reassembled_in", FT_FRAMENUM_NONE,
      "The frame that completes the message of this fragment");
}

void register_findings() {
  Registry& all = registry();
  FindingFields& f = all.finding;
  const int protocol = all.servotrace;
  const auto text = [&](int& id, const char* name, const char* filter, const char* blurb) {
    add_field(protocol, &id, name, filter, FT_STRING, BASE_NONE, nullptr, 0, blurb);
  };
  const auto frame = [&](int& id, const char* name, const char* filter, const char* blurb) {
    add_field(protocol, &id, name, filter, FT_FRAMENUM, BASE_NONE, nullptr, 0, blurb);
  };
  text(f.rule, "Rule", "servotrace.rule", "Id of the rule in the catalogue, RX201 for one");
  text(f.slug, "Slug", "servotrace.slug", "Name of the rule in words");
  text(f.severity, "Severity", "servotrace.severity", "error, warning or note");
  text(f.actor, "Actor", "servotrace.actor", "Who did it: master, drive, network or capture");
  text(f.title, "Title", "servotrace.title", "What the rule is about");
  text(f.message, "Message", "servotrace.message", "What was found");
  text(f.node, "Node", "servotrace.node", "Whose it is");
  add_field(protocol, &f.mac_id, "MAC ID", "servotrace.mac_id", FT_UINT8, BASE_DEC, nullptr, 0,
            "MAC ID of the axis or node; absent for a whole ring, bus or capture");
  text(f.section, "Manual", "servotrace.section", "Manual and section");
  text(f.why, "Why it matters", "servotrace.why", "What follows from it");
  text(f.fix, "What to do", "servotrace.fix", "How to put it right");
  add_field(protocol, &f.count, "Occurrences", "servotrace.count", FT_UINT32, BASE_DEC, nullptr, 0,
            "How often it was found from this frame to the last one, known once the whole file was read");
  frame(f.last_frame, "Last occurrence in", "servotrace.last_frame", "The last frame of the episode");
  frame(f.related, "Related frame", "servotrace.related", "A frame that shows the rest of it");
  text(f.cause, "Cause", "servotrace.cause", "Rule of the earlier finding this one answers");
  frame(f.cause_frame, "Cause in", "servotrace.cause_frame", "Frame of the earlier finding this one answers");
  text(f.basis, "Basis", "servotrace.basis",
       "What decided the setting the finding rests on: configured, capture or assumed");
  frame(f.basis_frame, "Basis in", "servotrace.basis_frame", "The frame that showed the setting");
}

int expert_severity(Severity severity) {
  switch (severity) {
    case Severity::kNote:
      return PI_NOTE;
    case Severity::kWarning:
      return PI_WARN;
    case Severity::kError:
      break;
  }
  return PI_ERROR;
}

int expert_group(Actor actor) {
  switch (actor) {
    case Actor::kMaster:
      return PI_PROTOCOL;
    case Actor::kDrive:
      return PI_RESPONSE_CODE;
    case Actor::kNetwork:
      return PI_SEQUENCE;
    case Actor::kCapture:
      break;
  }
  return PI_UNDECODED;
}

// Settings and circumstances change a finding's severity, and Wireshark's severities are fixed at registration: three
// expert items a rule, "servotrace.rx201" of the catalogue's severity, "servotrace.rx201.note" and so on of the others.
void register_experts() {
  Registry& all = registry();
  expert_module_t* const module = expert_register_protocol(all.servotrace);
  for (std::size_t i = 0; i < kRuleCount; ++i) {
    const Rule& row = kCatalogue[i];
    for (const Severity severity : {Severity::kNote, Severity::kWarning, Severity::kError}) {
      std::string name = "servotrace.";
      for (const char c : row.id) name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      if (severity != row.severity) {
        name += '.';
        name += name_of(severity);
      }
      expert_field& id = all.experts[i][static_cast<unsigned>(severity)];
      id = EI_INIT;
      ei_register_info& info = all.expert_rows.emplace_back();
      info = {&id,
              {all.texts.keep(name), expert_group(row.actor), expert_severity(severity), all.texts.keep(row.title),
               EXPFILL}};
      expert_register_field_array(module, &info, 1);
    }
  }
}

}  // namespace

void register_fields() {
  register_protocols();
  register_layouts();
  register_signals();
  place_signals();
  for (ProtocolRow& protocol : registry().protocols) {
    if (protocol.name == "rtex" || protocol.name == "dnet") register_links(protocol);
  }
  register_findings();
  Subtrees& trees = registry().subtrees;
  int* const places[] = {&trees.protocol, &trees.node, &trees.findings, &trees.finding};
  proto_register_subtree_array(places, 4);
  register_experts();
}

int protocol_id(std::string_view protocol) {
  const ProtocolRow* const row = find_protocol(protocol);
  return row == nullptr ? -1 : row->id;
}
int servotrace_protocol_id() { return registry().servotrace; }
const char* protocol_column(std::string_view protocol) {
  const ProtocolRow* const row = find_protocol(protocol);
  return row == nullptr ? "servotrace" : row->column;
}

LayoutFields fields_of(const Layout* layout) {
  const auto& all = registry().layouts;
  const auto found = all.find(layout);
  if (found == all.end()) return {};
  return {found->second.fields.data(), found->second.signals.data(), found->second.subtree};
}

DerivedIds ids_of(const Derived& derived) {
  const auto [begin, end] = registry().derived_of.equal_range(derived.field);
  for (auto entry = begin; entry != end; ++entry) {
    if (entry->second->protocol == derived.protocol) return entry->second->ids;
  }
  return {};
}

AxisSignal axis_signal(const Signal* signal, std::int16_t mac_id) {
  const auto node = static_cast<std::size_t>(mac_id);  // kNoMacId: out of range
  if (signal == nullptr || node >= signal->fields.size()) return {};
  return {signal->fields[node], signal->scaled};
}

const LinkFields& link_fields(Protocol protocol) {
  return registry().protocols[protocol == Protocol::kRtex ? 0 : 1].links;
}
const FindingFields& finding_fields() { return registry().finding; }
expert_field* expert_of(RuleId rule, Severity severity) {
  return &registry().experts[static_cast<std::size_t>(rule)][static_cast<unsigned>(severity)];
}
const Subtrees& subtrees() { return registry().subtrees; }

}  // namespace servotrace::plugin
