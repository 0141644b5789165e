// SPDX-License-Identifier: MIT
// Steps of a master of an NS310 (SIE-C718-7 5.4 to 5.6), and what happens to the machine around it.
#include <algorithm>

#include "captures/simulator/can_ns310.hpp"
#include "captures/simulator/can_world.hpp"
#include "decoder/profiles/yaskawa_ns310/layouts.hpp"

namespace servotrace::simulator {
namespace {

using namespace ns310;

constexpr unsigned kHandshakePolls = 20;
constexpr unsigned kMotionPolls = 3'000;

// The command as the master will send it next; keeps what is not changed.
class Image {
 public:
  Image(CanWorld& world, std::uint8_t mac_id) : world_(world), mac_id_(mac_id) {
    world_.scanned(mac_id_).command.resize(kMessageSize, 0);
  }
  void set(Slot place, std::int64_t value) {
    if (!write(place, bytes(), value)) world_.job.problems.add(world_.job.table.source(), "a value does not fit");
  }
  void set_data(std::int64_t value) {
    for (unsigned i = 0; i < 4; ++i)
      bytes()[kDataOffset + i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8U * i) & 0xFFU);
  }
  void poll(std::uint64_t cycles = 1) { world_.scanner.poll(mac_id_, cycles); }
  bool until(Slot signal, std::int64_t value, unsigned limit) {
    return world_.poll_until(mac_id_, signal, value, limit);
  }
  // Values first, then Valid Data and the start bit (5.4.1), as the manual's examples advise.
  void start(std::uint8_t code, std::int64_t data) {
    set(slot(kCommand, "start_trajectory"), 0);
    set(slot(kCommand, "command_code"), code);
    set_data(data);
    set(slot(kCommand, "valid_data"), 1);
    until(slot(kResponse, "valid_data"), 1, kHandshakePolls);
    set(slot(kCommand, "start_trajectory"), 1);
    until(slot(kResponse, "trajectory_start_echo"), 1, kHandshakePolls);
  }
  void give_value(std::uint8_t code, std::int64_t data) {
    set(slot(kCommand, "start_trajectory"), 0);
    set(slot(kCommand, "command_code"), code);
    set_data(data);
    set(slot(kCommand, "valid_data"), 1);
    poll(2);
  }
  void end_start() {
    set(slot(kCommand, "start_trajectory"), 0);
    poll();
  }
  void wait_still() { until(slot(kResponse, "trajectory_in_progress"), 0, kMotionPolls); }

 private:
  ByteVector& bytes() { return world_.scanned(mac_id_).command; }
  CanWorld& world_;
  std::uint8_t mac_id_;
};

Image image(CanWorld& world, TableReader& step) {
  const std::uint8_t mac_id = world.node(step);
  world.ns310(step);
  return Image(world, mac_id);
}

// Any bits and values, by the names of the command's fields; polls once unless told otherwise.
void command(CanWorld& world, TableReader& step) {
  Image master = image(world, step);
  for (const Field& field : kCommandFields) {
    if (!step.has(field.key)) continue;
    const Slot place = slot_of(field);
    const std::int64_t highest = (std::int64_t{1} << field.width) - 1;
    master.set(place, field.width == 1 ? step.boolean(field.key, false) : step.integer(field.key, 0, highest));
  }
  if (step.has("data")) master.set_data(step.integer("data", INT32_MIN, UINT32_MAX));
  const auto polls = static_cast<std::uint64_t>(step.integer("polls", 1, 0, 10'000));
  if (polls > 0) master.poll(polls);
}

void enable(CanWorld& world, TableReader& step) {
  Image master = image(world, step);
  master.set(slot(kCommand, "enable"), 1);
  master.until(slot(kResponse, "enable_state"), 1, 100);
}

void disable(CanWorld& world, TableReader& step) {
  Image master = image(world, step);
  master.set(slot(kCommand, "enable"), 0);
  master.until(slot(kResponse, "enable_state"), 0, 100);
}

void move(CanWorld& world, TableReader& step) {
  Image master = image(world, step);
  const bool relative = step.has("by");
  const std::int64_t target = step.integer(relative ? "by" : "to", INT32_MIN, INT32_MAX);
  const auto speed = step.optional_integer("speed", INT32_MIN, INT32_MAX);
  const auto response = step.integer("response_code", 1, 0, 31);
  const bool wait = step.boolean("wait", true);
  master.set(slot(kCommand, "response_code"), response);
  if (speed) master.give_value(0x02, *speed);
  master.set(slot(kCommand, "incremental"), relative);
  master.start(0x01, target);
  master.end_start();
  if (wait) master.wait_still();
}

void rotate(CanWorld& world, TableReader& step) {
  Image master = image(world, step);
  const std::int64_t speed = step.integer("speed", INT32_MIN, INT32_MAX);
  master.set(slot(kCommand, "direction"), step.boolean("forward", true));
  master.set(slot(kCommand, "response_code"), 3);
  const auto polls = static_cast<std::uint64_t>(step.integer("polls", 20, 1, 10'000));
  master.start(0x11, speed);
  master.poll(polls);
}

void home(CanWorld& world, TableReader& step) {
  Image master = image(world, step);
  const std::int64_t type = step.integer("type", 0, 255);
  const bool wait = step.boolean("wait", true);
  master.start(0x12, type);
  master.end_start();
  if (wait) master.wait_still();
}

// Holds the stop until the axis stands, as 5.4.4 and 5.4.5 ask.
void stop_motion(CanWorld& world, TableReader& step) {
  Image master = image(world, step);
  const bool hard = step.boolean("hard", false);
  const Slot place = hard ? slot(kCommand, "hard_stop") : slot(kCommand, "smooth_stop");
  master.set(slot(kCommand, "start_trajectory"), 0);
  master.set(place, 1);
  master.poll();
  master.wait_still();
  master.set(place, 0);
  master.poll();
}

void clear_alarm(CanWorld& world, TableReader& step) {
  Image master = image(world, step);
  master.start(0x1E, 1);
  master.end_start();
}

void read_code(CanWorld& world, TableReader& step) {
  Image master = image(world, step);
  master.set(slot(kCommand, "response_code"), step.integer("code", 0, 31));
  master.set(slot(kCommand, "command_code"), 0);
  master.set_data(0);
  master.set(slot(kCommand, "valid_data"), 1);
  master.poll(3);
}

void run_block(CanWorld& world, TableReader& step) {
  Image master = image(world, step);
  const bool wait = step.boolean("wait", true);
  master.set(slot(kCommand, "block_number"), step.integer("block", 0, 255));
  master.set(slot(kCommand, "command_code"), 0);
  master.set(slot(kCommand, "start_trajectory"), 0);
  master.set_data(0);
  master.set(slot(kCommand, "valid_data"), 1);
  master.until(slot(kResponse, "valid_data"), 1, kHandshakePolls);
  master.set(slot(kCommand, "start_block"), 1);
  master.poll(2);
  master.set(slot(kCommand, "start_block"), 0);
  master.poll();
  if (wait) master.until(slot(kResponse, "block_in_execution"), 0, kMotionPolls);
}

// A command block in the order of its attributes (Tables 5.5 to 5.16), whole or attribute by attribute.
void write_block(CanWorld& world, TableReader& step) {
  const std::uint8_t mac_id = world.node(step);
  const auto block = static_cast<std::uint8_t>(step.integer("block", 0, 255));
  const auto code = step.integer("command", 0, 255);
  const bool single = step.boolean("single", false);
  const auto until = static_cast<std::size_t>(step.integer("attributes", 7, 1, 7));
  struct Value {
    std::int64_t value;
    unsigned size;
  };
  std::vector<Value> values{{code, 1}, {step.integer("link", 0, 0, 255), 1}};
  const auto add = [&](std::string_view key, unsigned size, std::int64_t otherwise) {
    values.push_back({step.integer(key, otherwise, INT32_MIN, INT32_MAX), size});
  };
  if (code >= 0x01 && code <= 0x04) {
    add("class", 1, 0x25);
    add("instance", 1, 1);
    add("attribute", 1, code == 0x01 ? 8 : 13);
  }
  switch (code) {
    case 0x01:
      add("value", 4, 0);
      break;
    case 0x02:
      add("timeout_ms", 4, 0);
      add("compare", 4, 0);
      break;
    case 0x03:
    case 0x04:
      add("compare_link", 1, 0);
      add("compare", 4, 0);
      break;
    case 0x06:
      add("delay_ms", 4, 0);
      break;
    case 0x07:
    case 0x08:
      add("to", 4, 0);
      add("speed", 4, 0);
      add("incremental", 1, 0);
      break;
    case 0x09:
      add("speed", 4, 0);
      break;
    case 0x10:
      add("offset", 4, 0);
      add("speed", 4, 0);
      break;
    default:
      break;
  }
  const auto append = [](ByteVector& message, const Value& entry) {
    for (unsigned i = 0; i < entry.size; ++i)
      message.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(entry.value) >> (8U * i) & 0xFFU));
  };
  if (!single) {
    ByteVector message{service::kSetAttributesAll, 0x27, block};
    for (const Value& entry : values) append(message, entry);
    world.scanner.request(mac_id, message);
    return;
  }
  for (std::size_t i = 0; i < std::min(values.size(), until); ++i) {
    ByteVector message{service::kSetAttributeSingle, 0x27, block, static_cast<std::uint8_t>(i + 1)};
    append(message, values[i]);
    world.scanner.request(mac_id, message);
  }
}

void machine(CanWorld& world, TableReader& step) {
  Ns310* drive = world.ns310(step);
  if (drive == nullptr) return;
  if (const auto alarm = step.optional_integer("alarm", 0, 255)) drive->raise_alarm(static_cast<std::uint8_t>(*alarm));
  if (step.has("emergency")) drive->set_emergency_stop(step.boolean("emergency", false));
  if (step.has("cw_limit")) drive->set_cw_limit(step.boolean("cw_limit", false));
  if (step.has("ccw_limit")) drive->set_ccw_limit(step.boolean("ccw_limit", false));
  if (step.has("ready")) drive->set_servo_ready(step.boolean("ready", true));
  if (step.has("homed")) drive->set_homed(step.boolean("homed", true));
  if (step.has("home_switch")) {
    drive->set_home_switch(step.integer("home_switch", INT32_MIN, INT32_MAX),
                           step.integer("home_width", 2'000, 1, INT32_MAX));
  }
  if (const auto distance = step.optional_integer("phase_c", 1, INT32_MAX)) drive->set_phase_c(*distance);
}

void until(CanWorld& world, TableReader& step) {
  Image master = image(world, step);
  const std::string key = step.text("signal");
  const std::int64_t value = step.integer("is", 1, 0, 255);
  const auto limit = static_cast<unsigned>(step.integer("limit", kMotionPolls, 1, 100'000));
  const Field* field = kResponse.find(key);
  if (field == nullptr) {
    step.fail("signal", "the response has no \"" + key + '"');
    return;
  }
  if (!master.until(slot_of(*field), value, limit)) step.fail("signal", '"' + key + "\" never came");
}

constexpr CanStep kSteps[] = {
    {"command", command},     {"enable", enable},       {"disable", disable},         {"move", move},
    {"rotate", rotate},       {"home", home},           {"stop_motion", stop_motion}, {"clear_alarm", clear_alarm},
    {"read_code", read_code}, {"run_block", run_block}, {"write_block", write_block}, {"machine", machine},
    {"until", until},
};

}  // namespace

std::span<const CanStep> ns310_steps() { return kSteps; }

}  // namespace servotrace::simulator
