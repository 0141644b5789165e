// SPDX-License-Identifier: MIT
// What PRM_SET_DATA and PRM_GET_DATA (4 bytes) mean by their number: one layout a number of the command list, made from
// its row, and bit by bit for the alarm word (TA) and the input/output monitors (ESB 5.4.6). Filter names:
// esb.parameter, esb.command (managing, operation, editing), esb.program (program commands and optional codes) and
// esb.monitor.
#pragma once

#include "decoder/core/layout_check.hpp"
#include "decoder/profiles/nsk_esb/alarms.hpp"
#include "decoder/profiles/nsk_esb/number_facts.hpp"

namespace servotrace::esb {

inline constexpr std::string_view kMonitorSection = "ESB 5.4.6";

namespace detail {

constexpr std::string_view layout_key(Group group) {
  switch (group) {
    case Group::kParameter:
      return "parameter";
    case Group::kManaging:
    case Group::kOperation:
    case Group::kEditing:
      return "command";
    case Group::kProgram:
    case Group::kOption:
      return "program";
    case Group::kMonitor:
      return "monitor";
  }
  return "";
}

consteval auto number_fields() {
  std::array<Field, kNumbers.size()> fields{};
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const Number& row = kNumbers[i];
    fields[i] = Field{.key = row.key,
                      .label = row.mnemonic.empty() ? row.name : row.mnemonic,
                      .first_bit = 0,
                      .width = 32,
                      .kind = Kind::kSigned,
                      .role = row.group == Group::kMonitor && row.unit != Unit::kNone ? Role::kSignal : Role::kPlain,
                      .unit = row.unit,
                      .scale = row.scale,
                      .values = row.values,
                      .section = row.section,
                      .explanation = kNumberFacts[i].view()};
    // A single range without holes is shown as such; the others are the rules' business.
    if (row.has_range() && !row.or_zero && row.second.minimum == 0 && row.second.maximum == 0) {
      fields[i].range = row.range;
    }
  }
  return fields;
}
inline constexpr auto kNumberFields = number_fields();

consteval auto number_layouts() {
  std::array<Layout, kNumbers.size()> layouts{};
  for (std::size_t i = 0; i < layouts.size(); ++i) {
    layouts[i] = Layout{.protocol = "esb",
                        .key = layout_key(kNumbers[i].group),
                        .title = kNumbers[i].name,
                        .size = 4,
                        .fields = std::span<const Field>(&kNumberFields[i], 1),
                        .section = kNumbers[i].section};
  }
  return layouts;
}

// The signals of the input/output monitors in words.
struct SignalWords {
  std::string_view label;
  std::string_view words;
};
inline constexpr SignalWords kSignalWords[] = {
    {"SVON", "Servo on"},
    {"EMST", "Emergency stop"},
    {"RUN", "Start programmable indexer"},
    {"STP", "Decelerates to stop"},
    {"CLR", "Clear"},
    {"IOFF", "Integration off, or clamp cancel"},
    {"HOS", "Home return start"},
    {"ORD", "Override"},
    {"JOG", "Jog start"},
    {"DIR", "Jog direction"},
    {"HLS", "Home position limit sensor"},
    {"OTP", "+ over-travel limit"},
    {"OTM", "- over-travel limit"},
    {"DRDY", "Driver unit ready"},
    {"OVER", "Warning"},
    {"IPOS", "In position"},
    {"BUSY", "Processing generated pulses"},
    {"BRK", "Brake, or brake control signal"},
    {"HCMP", "Home position defined"},
    {"HOME", "Home return completed"},
    {"SPD", "Velocity threshold"},
    {"NEARA", "Target proximity / in target A"},
    {"NEARB", "Target proximity / in target B"},
};
constexpr std::string_view signal_words(std::string_view label) {
  for (const SignalWords& row : kSignalWords) {
    if (row.label == label) return row.words;
  }
  if (label.starts_with("PRG")) return "Program channel select, one bit of six";
  if (label.starts_with("ACK_PRG")) return "Move / program channel, one bit of six";
  return "Always 0";
}

// One bit a row, from bit 0 on; behind them the bits that mean nothing.
struct BitName {
  std::string_view key;
  std::string_view label;
};
template <std::size_t kBits>
consteval auto bit_fields(const BitName (&names)[kBits], std::string_view rest_key) {
  std::array<Field, kBits + 1> fields{};
  for (std::size_t i = 0; i < kBits; ++i) {
    fields[i] = Field{.key = names[i].key,
                      .label = names[i].label,
                      .first_bit = static_cast<std::uint16_t>(i),
                      .width = 1,
                      .kind = Kind::kBool,
                      .section = kMonitorSection,
                      .explanation = signal_words(names[i].label)};
  }
  fields[kBits] = Field{.key = rest_key,
                        .label = "(unused)",
                        .first_bit = static_cast<std::uint16_t>(kBits),
                        .width = static_cast<std::uint16_t>(32 - kBits),
                        .base = Base::kHex,
                        .section = kMonitorSection};
  return fields;
}

// 840 and 841 list the same signals.
inline constexpr BitName kIo0Bits[] = {{"io0_home", "HOME"}, {"io0_ipos", "IPOS"}, {"io0_brk", "BRK"},
                                       {"io0_drdy", "DRDY"}, {"io0_otp", "OTP"},   {"io0_otm", "OTM"},
                                       {"io0_clr", "CLR"},   {"io0_hos", "HOS"},   {"io0_hls", "HLS"},
                                       {"io0_ioff", "IOFF"}, {"io0_emst", "EMST"}, {"io0_svon", "SVON"}};
inline constexpr BitName kIo1Bits[] = {{"io1_home", "HOME"}, {"io1_ipos", "IPOS"}, {"io1_brk", "BRK"},
                                       {"io1_drdy", "DRDY"}, {"io1_otp", "OTP"},   {"io1_otm", "OTM"},
                                       {"io1_clr", "CLR"},   {"io1_hos", "HOS"},   {"io1_hls", "HLS"},
                                       {"io1_ioff", "IOFF"}, {"io1_emst", "EMST"}, {"io1_svon", "SVON"}};
inline constexpr BitName kIo2Bits[] = {
    {"io2_nearb", "NEARB"}, {"io2_neara", "NEARA"}, {"io2_ipos", "IPOS"}, {"io2_zero_3", "0"},  {"io2_zero_4", "0"},
    {"io2_stp", "STP"},     {"io2_run", "RUN"},     {"io2_prg0", "PRG0"}, {"io2_prg1", "PRG1"}, {"io2_prg2", "PRG2"},
    {"io2_prg3", "PRG3"},   {"io2_prg4", "PRG4"},   {"io2_prg5", "PRG5"}};
inline constexpr BitName kIo3Bits[] = {
    {"io3_hcmp", "HCMP"}, {"io3_home", "HOME"}, {"io3_spd", "SPD"},  {"io3_ipos", "IPOS"}, {"io3_over", "OVER"},
    {"io3_drdy", "DRDY"}, {"io3_ord", "ORD"},   {"io3_zero_7", "0"}, {"io3_stp", "STP"},   {"io3_hos", "HOS"},
    {"io3_run", "RUN"},   {"io3_dir", "DIR"},   {"io3_jog", "JOG"}};
inline constexpr BitName kIo4Bits[] = {
    {"io4_spd", "SPD"},   {"io4_home", "HOME"}, {"io4_hcmp", "HCMP"}, {"io4_brk", "BRK"}, {"io4_busy", "BUSY"},
    {"io4_ipos", "IPOS"}, {"io4_over", "OVER"}, {"io4_drdy", "DRDY"}, {"io4_jog", "JOG"}, {"io4_ord", "ORD"},
    {"io4_hos", "HOS"},   {"io4_ioff", "IOFF"}, {"io4_clr", "CLR"},   {"io4_stp", "STP"}, {"io4_run", "RUN"},
    {"io4_svon", "SVON"}, {"io4_emst", "EMST"}};
inline constexpr BitName kIo5Bits[] = {
    {"io5_nearb", "NEARB"},       {"io5_neara", "NEARA"},       {"io5_busy", "BUSY"},
    {"io5_ipos", "IPOS"},         {"io5_ack_prg0", "ACK_PRG0"}, {"io5_ack_prg1", "ACK_PRG1"},
    {"io5_ack_prg2", "ACK_PRG2"}, {"io5_ack_prg3", "ACK_PRG3"}, {"io5_ack_prg4", "ACK_PRG4"},
    {"io5_ack_prg5", "ACK_PRG5"}, {"io5_run", "RUN"},           {"io5_prg0", "PRG0"},
    {"io5_prg1", "PRG1"},         {"io5_prg2", "PRG2"},         {"io5_prg3", "PRG3"},
    {"io5_prg4", "PRG4"},         {"io5_prg5", "PRG5"}};
// Byte 0 F7..F0, byte 1 C7..C0, byte 2 A7..A0, byte 3 P7..P0.
inline constexpr BitName kAlarmBits[] = {
    {"ta_f0", "F0"}, {"ta_f1", "F1"}, {"ta_f2", "F2"}, {"ta_f3", "F3"}, {"ta_f4", "F4"}, {"ta_f5", "F5"},
    {"ta_f6", "F6"}, {"ta_f7", "F7"}, {"ta_c0", "C0"}, {"ta_c1", "C1"}, {"ta_c2", "C2"}, {"ta_c3", "C3"},
    {"ta_c4", "C4"}, {"ta_c5", "C5"}, {"ta_c6", "C6"}, {"ta_c7", "C7"}, {"ta_a0", "A0"}, {"ta_a1", "A1"},
    {"ta_a2", "A2"}, {"ta_a3", "A3"}, {"ta_a4", "A4"}, {"ta_a5", "A5"}, {"ta_a6", "A6"}, {"ta_a7", "A7"},
    {"ta_p0", "P0"}, {"ta_p1", "P1"}, {"ta_p2", "P2"}, {"ta_p3", "P3"}, {"ta_p4", "P4"}, {"ta_p5", "P5"},
    {"ta_p6", "P6"}, {"ta_p7", "P7"}};
// "F1 Excess position error"; a bit that names no alarm of Table 4-12 by its place alone.
constexpr std::string_view alarm_label(std::size_t bit) {
  for (std::size_t i = 0; i < kAlarms.size(); ++i) {
    if (kAlarms[i].word_bit == static_cast<int>(bit)) return kAlarmNames[i].name;
  }
  return kAlarmBits[bit].label;
}
consteval auto alarm_fields() {
  std::array<Field, std::size(kAlarmBits)> fields{};
  for (std::size_t i = 0; i < fields.size(); ++i) {
    fields[i] = Field{.key = kAlarmBits[i].key,
                      .label = alarm_label(i),
                      .first_bit = static_cast<std::uint16_t>(i),
                      .width = 1,
                      .kind = Kind::kBool,
                      .role = Role::kState,
                      .section = kMonitorSection};
  }
  return fields;
}

inline constexpr auto kAlarmFields = alarm_fields();
inline constexpr auto kIo0Fields = bit_fields(kIo0Bits, "io0_unused");
inline constexpr auto kIo1Fields = bit_fields(kIo1Bits, "io1_unused");
inline constexpr auto kIo2Fields = bit_fields(kIo2Bits, "io2_unused");
inline constexpr auto kIo3Fields = bit_fields(kIo3Bits, "io3_unused");
inline constexpr auto kIo4Fields = bit_fields(kIo4Bits, "io4_unused");
inline constexpr auto kIo5Fields = bit_fields(kIo5Bits, "io5_unused");
constexpr Layout monitor(std::string_view title, std::span<const Field> fields) {
  return {.protocol = "esb", .key = "monitor", .title = title, .size = 4, .fields = fields, .section = kMonitorSection};
}

}  // namespace detail

inline constexpr auto kNumberLayouts = detail::number_layouts();
inline constexpr Layout kAlarmWord = detail::monitor("Alarm (TA), bit by bit", detail::kAlarmFields);
inline constexpr Layout kIo0 = detail::monitor("Input/Output state (IO0)", detail::kIo0Fields);
inline constexpr Layout kIo1 = detail::monitor("Input/Output state (IO1)", detail::kIo1Fields);
inline constexpr Layout kIo2 = detail::monitor("Input/Output state (IO2)", detail::kIo2Fields);
inline constexpr Layout kIo3 = detail::monitor("Input/Output state (IO3)", detail::kIo3Fields);
inline constexpr Layout kIo4 = detail::monitor("Input/Output state (IO4)", detail::kIo4Fields);
inline constexpr Layout kIo5 = detail::monitor("Input/Output state (IO5)", detail::kIo5Fields);

inline constexpr const Layout* kBitLayouts[] = {&kAlarmWord, &kIo0, &kIo1, &kIo2, &kIo3, &kIo4, &kIo5};

namespace detail {
consteval bool all_well_formed() {
  for (const Layout& layout : kNumberLayouts) {
    if (!well_formed(layout)) return false;
  }
  for (const Layout* layout : kBitLayouts) {
    if (!well_formed(*layout)) return false;
  }
  return true;
}
}  // namespace detail
static_assert(detail::all_well_formed());

// The layout of the data of this number; nullptr where the number has none.
constexpr const Layout* data_layout(std::int64_t number) {
  switch (number) {
    case 800:
      return &kAlarmWord;
    case 840:
      return &kIo0;
    case 841:
      return &kIo1;
    case 842:
      return &kIo2;
    case 843:
      return &kIo3;
    case 844:
      return &kIo4;
    case 845:
      return &kIo5;
    default:
      break;
  }
  const Number* row = find_number(number);
  return row == nullptr || !row->has_data ? nullptr : &kNumberLayouts[static_cast<std::size_t>(row - kNumbers.data())];
}

}  // namespace servotrace::esb
