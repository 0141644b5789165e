// SPDX-License-Identifier: MIT
// Steps of a master of an ESB (ESB 4.3, 5.2, 5.3), and what happens around the drive.
#include "captures/simulator/can_esb.hpp"
#include "captures/simulator/can_world.hpp"
#include "decoder/profiles/nsk_esb/layouts.hpp"

namespace servotrace::simulator {
namespace {

using namespace esb;

constexpr unsigned kMotionPolls = 5'000;
constexpr unsigned kHandshakePolls = 1'000;

class Image {
 public:
  Image(CanWorld& world, std::uint8_t mac_id) : world_(world), mac_id_(mac_id) {
    world_.scanned(mac_id_).command.resize(kMessageSize, 0);
  }
  void set(Slot place, std::int64_t value) {
    if (!write(place, world_.scanned(mac_id_).command, value))
      world_.job.problems.add(world_.job.table.source(), "a value does not fit");
  }
  void poll(std::uint64_t cycles = 1) { world_.scanner.poll(mac_id_, cycles); }
  bool until(Slot signal, std::int64_t value, unsigned limit) {
    return world_.poll_until(mac_id_, signal, value, limit);
  }
  void wait_still() { until(slot(kOutput, "busy"), 0, kMotionPolls); }
  // The whole handshake of 5.2.1 or 5.2.2.
  void transact(bool write_it, std::int64_t number, std::int64_t data) {
    set(slot(kInput, "prm_ope"), write_it);
    set(slot(kInput, "prm_set_no"), number);
    set(slot(kInput, "prm_set_data"), data);
    poll();
    set(slot(kInput, "prm_req"), 1);
    until(slot(kOutput, "prm_ack"), 1, kHandshakePolls);
    set(slot(kInput, "prm_req"), 0);
    until(slot(kOutput, "prm_ack"), 0, kHandshakePolls);
  }
  // PRM_GET_NO of the last response.
  std::int64_t number() const {
    const std::optional<ByteVector>& last = world_.scanned(mac_id_).response;
    return last && last->size() == kMessageSize ? read(slot(kOutput, "prm_get_no"), *last) : -1;
  }

 private:
  CanWorld& world_;
  std::uint8_t mac_id_;
};

Image image(CanWorld& world, TableReader& step) {
  const std::uint8_t mac_id = world.node(step);
  world.esb(step);
  return Image(world, mac_id);
}

// Any signals, by the names of the input's fields; polls once unless told otherwise.
void input(CanWorld& world, TableReader& step) {
  Image master = image(world, step);
  for (const Field& field : kInputFields) {
    if (!step.has(field.key)) continue;
    const Slot place = slot_of(field);
    if (field.width == 1) {
      master.set(place, step.boolean(field.key, false));
    } else {
      master.set(place, step.integer(field.key, INT32_MIN, INT32_MAX));
    }
  }
  const auto polls = static_cast<std::uint64_t>(step.integer("polls", 1, 0, 10'000));
  if (polls > 0) master.poll(polls);
}

void servo_on(CanWorld& world, TableReader& step) {
  Image master = image(world, step);
  master.until(slot(kOutput, "drdy"), 1, 100);
  master.set(slot(kInput, "svon"), 1);
  master.until(slot(kOutput, "ipos"), 1, 100);
}

void servo_off(CanWorld& world, TableReader& step) {
  Image master = image(world, step);
  master.set(slot(kInput, "svon"), 0);
  master.poll(3);
}

void run(CanWorld& world, TableReader& step) {
  Image master = image(world, step);
  const bool wait = step.boolean("wait", true);
  master.set(slot(kInput, "prg"), step.integer("channel", 0, 63));
  master.poll(2);
  master.set(slot(kInput, "run"), 1);
  master.poll(2);
  master.set(slot(kInput, "run"), 0);
  master.poll();
  if (wait) master.wait_still();
}

void jog(CanWorld& world, TableReader& step) {
  Image master = image(world, step);
  master.set(slot(kInput, "dir"), step.boolean("ccw", false));
  master.set(slot(kInput, "jog"), 1);
  master.poll(static_cast<std::uint64_t>(step.integer("polls", 20, 1, 10'000)));
  master.set(slot(kInput, "jog"), 0);
  master.poll();
  master.wait_still();
}

void home_return(CanWorld& world, TableReader& step) {
  Image master = image(world, step);
  const bool wait = step.boolean("wait", true);
  master.set(slot(kInput, "hos"), 1);
  master.poll(2);
  master.set(slot(kInput, "hos"), 0);
  master.poll();
  if (wait) master.wait_still();
}

void write_number(CanWorld& world, TableReader& step) {
  Image master = image(world, step);
  const std::int64_t number = step.integer("number", INT16_MIN, INT16_MAX);
  const std::int64_t value = step.integer("value", 0, INT32_MIN, INT32_MAX);
  const auto times = step.integer("times", 1, 1, 1000);
  const bool wait_still = step.boolean("wait_still", false);
  for (std::int64_t i = 0; i < times; ++i) master.transact(true, number, value);
  if (wait_still) master.wait_still();
}

void read_number(CanWorld& world, TableReader& step) {
  Image master = image(world, step);
  master.transact(false, step.integer("number", INT16_MIN, INT16_MAX), 0);
}

// 500, a program command with its optional codes, 502 (5.3.1): each line for a channel of its own, from `channel` on,
// or all for one.
void edit_program(CanWorld& world, TableReader& step) {
  Image master = image(world, step);
  std::int64_t channel = step.integer("channel", 0, 63);
  const bool close = step.boolean("close", true);
  const bool one_channel = step.boolean("one_channel", false);
  const std::vector<const toml::table*> lines = step.tables("lines");
  for (const toml::table* table : lines) {
    if (!one_channel || table == lines.front()) master.transact(true, 500, channel++);
    TableReader line(*table, world.job.problems);
    const std::int64_t command = line.integer("command", INT16_MIN, INT16_MAX);
    master.transact(true, command, line.integer("data", 0, INT32_MIN, INT32_MAX));
    struct Option {
      std::string_view key;
      std::int64_t number;
    };
    for (const Option& option : {Option{"division", 660}, Option{"oe", 661}, Option{"cv", 662}, Option{"ca", 663}}) {
      if (const auto value = line.optional_integer(option.key, INT32_MIN, INT32_MAX))
        master.transact(true, option.number, *value);
    }
    line.done();
    const bool last = table == lines.back();
    if (last ? close : !one_channel) master.transact(true, 502, 0);
  }
}

// 501, 820 until it returns -1, 502 (5.3.2).
void read_program(CanWorld& world, TableReader& step) {
  Image master = image(world, step);
  const bool close = step.boolean("close", true);
  master.transact(true, 501, step.integer("channel", 0, 63));
  for (int i = 0; i < 100; ++i) {
    master.transact(false, 820, 0);
    if (master.number() == -1) break;
  }
  if (close) master.transact(true, 502, 0);
}

void drive(CanWorld& world, TableReader& step) {
  Esb* model = world.esb(step);
  if (model == nullptr) return;
  if (step.has("alarm")) {
    const std::string name = step.text("alarm");
    const EsbAlarm* alarm = find_esb_alarm(name);
    if (alarm == nullptr) {
      step.fail("alarm", "there is no alarm \"" + name + '"');
      return;
    }
    model->raise_alarm(*alarm);
  }
  if (step.boolean("clear", false)) model->clear_alarm();
  if (step.has("emergency")) model->set_emergency_input(step.boolean("emergency", false));
  if (step.has("over_travel")) {
    const int side = step.choice<int>("over_travel", 0, {{"none", 0}, {"plus", 1}, {"minus", 2}});
    model->set_over_travel(side == 1, side == 2);
  }
  if (step.has("homed")) model->set_homed(step.boolean("homed", true));
  if (step.has("parameter")) {
    model->set_parameter(static_cast<std::uint16_t>(step.integer("parameter", 1, 299)),
                         static_cast<std::int32_t>(step.integer("value", INT32_MIN, INT32_MAX)));
  }
}

// What the drive does wrong with the next transaction, or with RUN.
void drive_fault(CanWorld& world, TableReader& step) {
  Esb* model = world.esb(step);
  if (model == nullptr) return;
  if (step.has("success")) model->next_result = step.boolean("success", true);
  if (const auto number = step.optional_integer("number", INT16_MIN, INT16_MAX))
    model->next_number = static_cast<std::int16_t>(*number);
  if (const auto duration = step.optional_milliseconds("processing_ms")) model->next_processing_ns = *duration;
  if (const auto duration = step.optional_milliseconds("hold_acknowledge_ms")) model->acknowledge_hold_ns = *duration;
  if (step.has("ignore_run")) model->ignore_run = step.boolean("ignore_run", true);
}

void until_output(CanWorld& world, TableReader& step) {
  Image master = image(world, step);
  const std::string key = step.text("signal");
  const std::int64_t value = step.integer("is", 1, 0, 255);
  const auto limit = static_cast<unsigned>(step.integer("limit", kMotionPolls, 1, 100'000));
  const Field* field = kOutput.find(key);
  if (field == nullptr) {
    step.fail("signal", "the output has no \"" + key + '"');
    return;
  }
  if (!master.until(slot_of(*field), value, limit)) step.fail("signal", '"' + key + "\" never came");
}

constexpr CanStep kSteps[] = {
    {"input", input},
    {"servo_on", servo_on},
    {"servo_off", servo_off},
    {"run", run},
    {"jog", jog},
    {"home_return", home_return},
    {"write", write_number},
    {"read", read_number},
    {"edit_program", edit_program},
    {"read_program", read_program},
    {"drive", drive},
    {"drive_fault", drive_fault},
    {"until_output", until_output},
};

}  // namespace

std::span<const CanStep> esb_steps() { return kSteps; }

}  // namespace servotrace::simulator
