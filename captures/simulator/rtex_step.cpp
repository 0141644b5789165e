// SPDX-License-Identifier: MIT
#include "captures/simulator/rtex_step.hpp"

#include <charconv>

namespace servotrace::simulator::ring {
namespace {

constexpr std::int64_t kInt32Max = INT32_MAX;
constexpr std::int64_t kInt32Min = INT32_MIN;

// The words of `do`.
enum class Word : std::uint8_t {
  kWait,
  kSync,
  kServoOn,
  kServoOff,
  kMove,
  kJump,
  kSpeed,
  kTorque,
  kMode,
  kProfile,
  kProfileUpdate,
  kProfileEnd,
  kCommand,
  kSystemId,
  kParameterRead,
  kParameterWrite,
  kParameterAttribute,
  kParameterCount,
  kEepromWrite,
  kAlarmRead,
  kAlarmClear,
  kAlarmAttribute,
  kAlarmHistoryClear,
  kScaleClear,
  kMonitor,
  kHoming,
  kReset,
  kValidate,
  kControl,
  kNop,
  kDrive
};

Word read_word(TableReader& reader) {
  if (!reader.has("do")) reader.fail("do", "\"do\" is missing");
  return reader.choice<Word>("do", Word::kWait,
                             {{"wait", Word::kWait},
                              {"sync", Word::kSync},
                              {"servo_on", Word::kServoOn},
                              {"servo_off", Word::kServoOff},
                              {"move", Word::kMove},
                              {"jump", Word::kJump},
                              {"speed", Word::kSpeed},
                              {"torque", Word::kTorque},
                              {"mode", Word::kMode},
                              {"profile", Word::kProfile},
                              {"profile_update", Word::kProfileUpdate},
                              {"profile_end", Word::kProfileEnd},
                              {"command", Word::kCommand},
                              {"system_id", Word::kSystemId},
                              {"parameter_read", Word::kParameterRead},
                              {"parameter_write", Word::kParameterWrite},
                              {"parameter_attribute", Word::kParameterAttribute},
                              {"parameter_count", Word::kParameterCount},
                              {"eeprom_write", Word::kEepromWrite},
                              {"alarm_read", Word::kAlarmRead},
                              {"alarm_clear", Word::kAlarmClear},
                              {"alarm_attribute", Word::kAlarmAttribute},
                              {"alarm_history_clear", Word::kAlarmHistoryClear},
                              {"scale_clear", Word::kScaleClear},
                              {"monitor", Word::kMonitor},
                              {"homing", Word::kHoming},
                              {"reset", Word::kReset},
                              {"validate", Word::kValidate},
                              {"control", Word::kControl},
                              {"nop", Word::kNop},
                              {"drive", Word::kDrive}});
}

// What every non-cyclic command may carry.
void read_handshake(TableReader& reader, std::int64_t cycles_per_second, Step& step) {
  Request& request = step.request;
  request.sub = reader.choice<bool>("channel", false, {{"main", false}, {"sub", true}});
  request.leave = reader.choice<Leave>("leave", request.leave,
                                       {{"done", Leave::kDone},
                                        {"echo", Leave::kEcho},
                                        {"all_echo", Leave::kAllEcho},
                                        {"running", Leave::kRunning},
                                        {"never", Leave::kKeep}});
  if (const auto cycles = reader.optional_integer("leave_after_cycles", 1, 1'000'000)) {
    request.leave = Leave::kCycles;
    request.cycles = *cycles;
  }
  if (reader.has("hold_ms")) request.cycles = reader.milliseconds("hold_ms", 0) * cycles_per_second / kSecondNs;
  request.chain = reader.boolean("chain", false);
  request.settle = reader.boolean("settle", true);
  if (const auto data3 = reader.optional_integer("data3", kInt32Min, kInt32Max))
    request.data3 = static_cast<std::int32_t>(*data3);
  step.busy_ns = reader.optional_milliseconds("busy_ms");
  step.err = reader.boolean("err", false);
  step.wng = reader.boolean("wng", false);
}

void read_arguments(TableReader& reader, Word word, Step& step) {
  Request& request = step.request;
  const auto code = [&](int non_cyclic, int type) {
    request.code = non_cyclic;
    request.type = type;
  };
  switch (word) {
    case Word::kCommand:
      code(static_cast<int>(reader.integer("code", 0, 15)), static_cast<int>(reader.integer("type", 0, 0, 0xFFF)));
      request.index = static_cast<int>(reader.integer("index", 0, 0, 0xFFFF));
      break;
    case Word::kSystemId:
      code(kSystemIdCommand, static_cast<int>(reader.integer("type", 0, 0xFFF)));
      request.index = static_cast<int>(reader.integer("index", 0, 0, 0xFFFF));
      break;
    case Word::kParameterRead:
    case Word::kParameterAttribute:
      code(kParameterCommand, word == Word::kParameterRead ? 0x010 : 0x040);
      request.index = read_parameter(reader, "parameter");
      break;
    case Word::kParameterWrite:
      code(kParameterCommand, 0x011);
      request.index = read_parameter(reader, "parameter");
      request.data3 = static_cast<std::int32_t>(reader.integer("value", kInt32Min, kInt32Max));
      break;
    case Word::kParameterCount:
      code(kParameterCommand, 0x030);
      request.index = static_cast<int>(reader.integer("class", 0, 255)) << 8;
      break;
    case Word::kEepromWrite:
      code(kParameterCommand, reader.boolean("conventional", false) ? 0x101 : 0x081);
      break;
    case Word::kAlarmRead:
      code(kAlarmCommand, 0x000);
      request.index = static_cast<int>(reader.integer("index", 0, 0, 0xFFFF));
      break;
    case Word::kAlarmClear:
      code(kAlarmCommand, 0x001);
      break;
    case Word::kAlarmAttribute:
      code(kAlarmCommand, 0x002);
      request.index = static_cast<int>(reader.integer("main", 0, 0, 255) | reader.integer("sub", 0, 0, 255) << 8);
      break;
    case Word::kAlarmHistoryClear:
      code(kAlarmCommand, 0x011);
      break;
    case Word::kScaleClear:
      code(kAlarmCommand, 0x021);
      break;
    case Word::kMonitor:
      code(kMonitorCommand, static_cast<int>(reader.integer("type", 0, 0xFFF)));
      request.index = static_cast<int>(reader.integer("index", 0, 0, 0xFFFF));
      break;
    case Word::kHoming:
      code(kHomingCommand, static_cast<int>(reader.integer("type", 0, 0xFF)));
      request.index = static_cast<int>(reader.integer("latch1", 0, 0, 15) | reader.integer("latch2", 0, 0, 15) << 4 |
                                       reader.integer("monitor", 0, 0, 255) << 8);
      if (const auto value = reader.optional_integer("value", kInt32Min, kInt32Max))
        request.data3 = static_cast<std::int32_t>(*value);
      request.reference = reader.boolean("reference", true);
      // Homing to a trigger is done while the master goes on moving toward it.
      step.speed = reader.integer("speed", 0, kInt32Min, kInt32Max);
      break;
    case Word::kReset:
      code(kResetCommand, 0x001);
      request.leave = Leave::kAllEcho;
      request.settle = false;
      break;
    case Word::kValidate:
      code(kResetCommand, 0x011);
      break;
    default:
      break;
  }
}

void read_profile(TableReader& reader, Step& step) {
  Request& request = step.request;
  request.code = kProfileCommand;
  request.type = reader.choice<int>("type", 0x10,
                                    {{"absolute", 0x10},
                                     {"relative", 0x11},
                                     {"latch_absolute", 0x12},
                                     {"latch_relative", 0x13},
                                     {"continuous", 0x20},
                                     {"homing1", 0x31},
                                     {"homing2", 0x32},
                                     {"homing3", 0x33}});
  if (const auto code = reader.optional_integer("type_code", 0, 0xFF)) request.type = static_cast<int>(*code);
  request.index = static_cast<int>(reader.integer("latch", 0, 0, 255) | reader.integer("monitor", 0, 0, 255) << 8);
  step.target = reader.integer("position", 0, kInt32Min, kInt32Max);
  request.data3 = static_cast<std::int32_t>(reader.integer("speed", 0, kInt32Min, kInt32Max));
  step.together = reader.boolean("with_mode_change", false);
}

void read_control(TableReader& reader, Step& step) {
  static constexpr struct {
    std::string_view key;
    Slot bit;
  } kBits[] = {{"servo_on", command::kServoOn},   {"gain_sw", command::kGainSw},
               {"tl_sw", command::kTlSw},         {"homing_ctrl", command::kHomingCtrl},
               {"hard_stop", command::kHardStop}, {"smooth_stop", command::kSmoothStop},
               {"pause", command::kPause},        {"sl_sw", command::kSlSw},
               {"ex_out1", command::kExOut1},     {"ex_out2", command::kExOut2}};
  for (const auto& entry : kBits) {
    if (reader.has(entry.key)) step.control.push_back({entry.bit, reader.boolean(entry.key, false)});
  }
}

void read_drive(TableReader& reader, Step& step) {
  if (const toml::array* alarm = reader.array("alarm")) {
    const auto number = [&](std::size_t place) -> std::uint8_t {
      const toml::node* node = alarm->get(place);
      const auto* value = node == nullptr ? nullptr : node->as_integer();
      if (value != nullptr && value->get() >= 0 && value->get() <= 255) return static_cast<std::uint8_t>(value->get());
      reader.fail("alarm", "\"alarm\" must be [main, sub]");
      return 0;
    };
    step.alarm = AlarmCode{number(0), number(1)};
  }
  if (const auto warning = reader.optional_integer("warning", 0, 255))
    step.warning = static_cast<std::uint8_t>(*warning);
  if (reader.has("input")) {
    step.input = reader.choice<unsigned>("input", 2U,
                                         {{"not", 0U},
                                          {"pot", 1U},
                                          {"home", 2U},
                                          {"ext1", 3U},
                                          {"ext2", 4U},
                                          {"ext3", 5U},
                                          {"si_mon4", 6U},
                                          {"e_stop", 7U}});
  }
  step.active = reader.boolean("active", true);
  if (reader.has("main_power")) step.main_power = reader.boolean("main_power", true);
  if (reader.has("blocked")) step.blocked = reader.boolean("blocked", true);
}

int read_mode(TableReader& reader, std::string_view key) {
  return reader.choice<int>(key, kCp, {{"pp", kPp}, {"cp", kCp}, {"cv", kCv}, {"ct", kCt}});
}

void read_motion(TableReader& reader, Word word, Step& step) {
  switch (word) {
    case Word::kMove:
    case Word::kJump:
      step.relative = reader.has("by");
      if (reader.has("by") == reader.has("to")) reader.fail("do", "needs either \"to\" or \"by\"");
      step.target =
          reader.has("by") ? reader.integer("by", kInt32Min, kInt32Max) : reader.integer("to", 0, kInt32Min, kInt32Max);
      if (word == Word::kMove) step.speed = reader.integer("speed", 50'000, 1, 100'000'000);
      if (word == Word::kMove) step.rate = reader.integer("acceleration", 1'000'000, 1, 1'000'000'000);
      break;
    case Word::kSpeed:
    case Word::kTorque:
      step.target = reader.integer("value", kInt32Min, kInt32Max);
      step.for_ns = reader.milliseconds("ramp_ms", 0);
      break;
    case Word::kMode:
      if (!reader.has("to")) reader.fail("to", "\"to\" is missing");
      step.mode = read_mode(reader, "to");
      step.hurry = reader.boolean("hurry", false);
      step.first_value = reader.optional_integer("first_value", kInt32Min, kInt32Max);
      break;
    default:
      break;
  }
}

Do kind_of(Word word) {
  switch (word) {
    case Word::kWait:
      return Do::kWait;
    case Word::kSync:
      return Do::kSync;
    case Word::kServoOn:
      return Do::kServoOn;
    case Word::kServoOff:
      return Do::kServoOff;
    case Word::kMove:
      return Do::kMove;
    case Word::kJump:
      return Do::kJump;
    case Word::kSpeed:
      return Do::kSpeed;
    case Word::kTorque:
      return Do::kTorque;
    case Word::kMode:
      return Do::kMode;
    case Word::kProfile:
      return Do::kStartProfile;
    case Word::kProfileUpdate:
      return Do::kProfileUpdate;
    case Word::kProfileEnd:
      return Do::kProfileEnd;
    case Word::kControl:
      return Do::kControl;
    case Word::kNop:
      return Do::kSendNop;
    case Word::kDrive:
      return Do::kDrive;
    default:
      return Do::kCommand;
  }
}

}  // namespace

int read_parameter(TableReader& reader, std::string_view key) {
  const std::string text = reader.text(key);
  const std::size_t dot = text.find('.');
  int parts[2] = {-1, -1};
  if (dot != std::string::npos) {
    const char* const end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), text.data() + dot, parts[0]);
    const auto second = std::from_chars(text.data() + dot + 1, end, parts[1]);
    if (first.ptr != text.data() + dot || second.ptr != end) parts[0] = -1;
  }
  if (parts[0] < 0 || parts[0] > 255 || parts[1] < 0 || parts[1] > 255) {
    reader.fail(key, '"' + std::string(key) + "\" must be class and number, like \"7.23\"");
    return 0;
  }
  return parts[0] << 8 | parts[1];
}

void read_step(const toml::table& table, Problems& problems, std::int64_t cycles_per_second, std::vector<Step>& steps) {
  TableReader reader(table, problems);
  Step step;
  step.where = table.source();
  const Word word = read_word(reader);
  step.what = kind_of(word);
  step.axis = static_cast<int>(reader.integer("axis", -1, 0, 31));
  step.at_ns = reader.optional_milliseconds("at_ms");
  step.give_up_ns = reader.milliseconds("give_up_ms", 2 * kSecondNs);
  std::int64_t count = 1;
  switch (step.what) {
    case Do::kWait:
      if (reader.has("ms") == reader.has("cycles") && !step.at_ns)
        reader.fail("do", "wait needs one of \"ms\", \"cycles\" and \"at_ms\"");
      step.for_ns = reader.milliseconds("ms", 0);
      step.cycles = reader.integer("cycles", 0, 0, 100'000'000);
      break;
    case Do::kSendNop:
      step.cycles = reader.integer("cycles", 1, 1, 1'000'000);
      break;
    case Do::kServoOn:
    case Do::kServoOff:
      step.wait = reader.boolean("wait", true);
      break;
    case Do::kStartProfile:
      read_profile(reader, step);
      read_handshake(reader, cycles_per_second, step);
      break;
    case Do::kProfileUpdate:
      step.target = reader.integer("position", 0, kInt32Min, kInt32Max);
      step.request.data3 = static_cast<std::int32_t>(reader.integer("speed", kInt32Min, kInt32Max));
      if (const auto code = reader.optional_integer("type_code", 0, 0xFF)) step.request.type = static_cast<int>(*code);
      break;
    case Do::kControl:
      read_control(reader, step);
      break;
    case Do::kDrive:
      read_drive(reader, step);
      break;
    case Do::kCommand:
      read_arguments(reader, word, step);
      read_handshake(reader, cycles_per_second, step);
      if (word == Word::kSystemId) count = reader.integer("count", 1, 1, 64);
      break;
    default:
      read_motion(reader, word, step);
      break;
  }
  if (const toml::table* fault = reader.table("fault"))
    step.faults.push_back(read_fault(*fault, problems, cycles_per_second, true));
  reader.done();
  for (std::int64_t i = 0; i < count; ++i) {
    steps.push_back(step);
    ++step.request.index;
    step.faults.clear();
  }
}

}  // namespace servotrace::simulator::ring
