// SPDX-License-Identifier: MIT
#include "captures/simulator/rtex_fault.hpp"

namespace servotrace::simulator::ring {
namespace {

Slot read_field(TableReader& reader, bool of_command) {
  if (!reader.has("field")) {
    reader.fail("field", "\"field\" is missing");
    return response::kCr;
  }
  if (of_command) {
    return reader.choice<Slot>("field", command::kCr,
                               {{"mac_id", command::kMacId},
                                {"update_counter", command::kUpdateCounter},
                                {"cr", command::kCr},
                                {"cyclic_code", command::kCyclic},
                                {"non_cyclic_code", command::kNonCyclic},
                                {"tmg_cnt", command::kTmgCnt},
                                {"servo_on", command::kServoOn},
                                {"data1", command::kData1},
                                {"type_code", command::kTypeCode},
                                {"index", command::kIndex},
                                {"data3", command::kData3},
                                {"sub_chk", command::kSubChk},
                                {"sub_code", command::kSubCode},
                                {"sub_type_code", command::kSubTypeCode},
                                {"sub_index", command::kSubIndex},
                                {"sub_data1", command::kSubData1},
                                {"sub_data2", command::kSubData2},
                                {"sub_data3", command::kSubData3}});
  }
  return reader.choice<Slot>("field", response::kCr,
                             {{"mac_id", response::kMacId},
                              {"update_counter_echo", response::kCounterEcho},
                              {"cr", response::kCr},
                              {"code_echo", response::kCodeEcho},
                              {"cmd_error", response::kCmdError},
                              {"servo_active", response::kServoActive},
                              {"servo_ready", response::kServoReady},
                              {"alarm", response::kAlarm},
                              {"warning", response::kWarning},
                              {"homing_complete", response::kHomingComplete},
                              {"in_progress", response::kInProgress},
                              {"torque_limited", response::kTorqueLimited},
                              {"inputs", response::kInputs},
                              {"data1", response::kData1},
                              {"type_code_echo", response::kTypeLow},
                              {"index_echo", response::kIndexEcho},
                              {"busy", response::kBusy},
                              {"data3", response::kData3}});
}

}  // namespace

Fault read_fault(const toml::table& table, Problems& problems, std::int64_t cycles_per_second, bool in_step) {
  TableReader reader(table, problems);
  Fault fault;
  fault.relative = in_step;
  if (!reader.has("kind")) reader.fail("kind", "\"kind\" is missing");
  fault.kind = reader.choice<FaultKind>("kind", FaultKind::kDrop,
                                        {{"counter_stuck", FaultKind::kCounterStuck},
                                         {"counter_skip", FaultKind::kCounterSkip},
                                         {"counter_early", FaultKind::kCounterEarly},
                                         {"counter_set", FaultKind::kCounterSet},
                                         {"command_field", FaultKind::kCommandField},
                                         {"response_field", FaultKind::kResponseField},
                                         {"command_byte", FaultKind::kCommandByte},
                                         {"response_byte", FaultKind::kResponseByte},
                                         {"crc_error", FaultKind::kCrcError},
                                         {"silent", FaultKind::kSilent},
                                         {"frozen", FaultKind::kFrozen},
                                         {"hold_echo", FaultKind::kHoldEcho},
                                         {"late", FaultKind::kLate},
                                         {"stall", FaultKind::kStall},
                                         {"initialise", FaultKind::kInitialise},
                                         {"drop", FaultKind::kDrop},
                                         {"cut", FaultKind::kCut},
                                         {"repeat", FaultKind::kRepeat},
                                         {"stamp_early", FaultKind::kStamp},
                                         {"header_byte", FaultKind::kHeaderByte}});
  fault.axis = static_cast<int>(reader.integer("axis", -1, 0, 31));
  const auto to_cycles = [&](DurationNs time_ns) { return time_ns * cycles_per_second / kSecondNs; };
  fault.first_cycle =
      reader.has("at_ms") ? to_cycles(reader.milliseconds("at_ms", 0)) : reader.integer("at_cycle", 0, 0, 100'000'000);
  if (reader.has("at_ms") && reader.has("at_cycle"))
    reader.fail("at_ms", "\"at_ms\" and \"at_cycle\" exclude each other");
  fault.cycles =
      reader.has("for_ms") ? to_cycles(reader.milliseconds("for_ms", 0)) : reader.integer("cycles", 1, 1, 100'000'000);
  switch (fault.kind) {
    case FaultKind::kCommandField:
    case FaultKind::kResponseField:
      fault.field = read_field(reader, fault.kind == FaultKind::kCommandField);
      fault.value = reader.integer("value", INT32_MIN, UINT32_MAX);
      break;
    case FaultKind::kCommandByte:
    case FaultKind::kResponseByte:
    case FaultKind::kHeaderByte:
      fault.byte = static_cast<unsigned>(reader.integer("byte", 0, 31));
      fault.value = reader.integer("value", 0, 255);
      break;
    case FaultKind::kCounterSkip:
    case FaultKind::kCounterSet:
      fault.value = reader.integer("value", 0, 3);
      break;
    case FaultKind::kLate:
    case FaultKind::kStamp:
      fault.value = reader.integer("us", 0, 100'000'000);
      break;
    case FaultKind::kCut:
      fault.value = reader.integer("keep", 0, 4096);
      break;
    default:
      break;
  }
  const bool of_record = fault.kind >= FaultKind::kDrop;
  if (of_record) {
    fault.records = reader.choice<Records>(
        "records", Records::kBoth,
        {{"command", Records::kCommand}, {"response", Records::kResponse}, {"both", Records::kBoth}});
  }
  reader.done();
  return fault;
}

}  // namespace servotrace::simulator::ring
