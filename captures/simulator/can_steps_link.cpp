// SPDX-License-Identifier: MIT
// Steps every DeviceNet scanner does: power, allocation, explicit messages, polling.
#include <algorithm>

#include "captures/simulator/can_world.hpp"

namespace servotrace::simulator {
namespace {

constexpr DurationNs kBootNs = 2'050 * kMillisecondNs;  // two MAC checks, one second apart

std::uint8_t choice_bits(TableReader& step, std::uint8_t otherwise) {
  if (!step.has("choice")) return otherwise;
  if (const toml::node* node = step.array("choice"); node == nullptr) return otherwise;
  static constexpr std::string_view kWords[] = {"explicit", "poll",   "bit-strobe",           "multicast-poll",
                                                "cos",      "cyclic", "acknowledge-suppress", "reserved"};
  unsigned bits = 0;
  for (const std::string& word : step.texts("choice")) {
    const auto* found = std::find(std::begin(kWords), std::end(kWords), word);
    if (found == std::end(kWords)) {
      step.fail("choice", "there is no allocation choice \"" + word + '"');
      return otherwise;
    }
    bits |= 1U << static_cast<unsigned>(found - std::begin(kWords));
  }
  return static_cast<std::uint8_t>(bits);
}

std::optional<std::uint8_t> other_master(TableReader& step) {
  const std::optional<std::int64_t> master = step.optional_integer("master", 0, 63);
  if (!master) return std::nullopt;
  return static_cast<std::uint8_t>(*master);
}

Scanner::Options request_options(TableReader& step) {
  Scanner::Options options;
  options.wait = step.boolean("wait", true);
  options.timeout_ns = step.milliseconds("timeout_ms", kSecondNs);
  if (const auto xid = step.optional_integer("xid", 0, 1)) options.xid = static_cast<unsigned>(*xid);
  options.master = other_master(step);
  options.unconnected = step.boolean("unconnected", false);
  options.fragment_pause_ns = step.milliseconds("fragment_pause_ms", 0);
  if (const auto count = step.optional_integer("stop_after_fragments", 1, 64))
    options.stop_after_fragments = static_cast<std::size_t>(*count);
  return options;
}

std::uint8_t small(TableReader& step, std::string_view key) {
  return static_cast<std::uint8_t>(step.integer(key, 0, 255));
}
std::uint8_t small(TableReader& step, std::string_view key, std::int64_t otherwise) {
  return static_cast<std::uint8_t>(step.integer(key, otherwise, 0, 255));
}

void power_up(CanWorld& world, TableReader& step) {
  Slave& slave = *world.slave(world.node(step));
  const auto checks = static_cast<unsigned>(step.integer("checks", 2, 0, 10));
  const bool wait = step.boolean("wait", true);
  slave.power_up(checks);
  if (wait) world.bus.run(world.bus.now_ns() + checks * kSecondNs + kBootNs - 2 * kSecondNs);
}

void power_up_twin(CanWorld& world, TableReader& step) {
  const std::uint8_t mac_id = world.node(step);
  const bool wait = step.boolean("wait", true);
  const auto twin = std::find_if(world.slaves.rbegin(), world.slaves.rend(),
                                 [mac_id](const auto& slave) { return slave->settings().mac_id == mac_id; });
  (*twin)->power_up();  // world.node() has found one
  if (wait) world.bus.run(world.bus.now_ns() + kBootNs);
}

void power_off(CanWorld& world, TableReader& step) { world.slave(world.node(step))->power_off(); }

void was_running(CanWorld& world, TableReader& step) {
  const std::uint8_t mac_id = world.node(step);
  const bool allocated = step.boolean("allocated", true);
  const auto epr_ms = static_cast<std::uint16_t>(step.integer("epr_ms", 100, 0, 0xFFFF));
  world.slave(mac_id)->was_running(allocated ? world.scanner.mac_id() : -1, epr_ms);
  world.scanned(mac_id).polled = allocated;
}

void allocate(CanWorld& world, TableReader& step) {
  const std::uint8_t mac_id = world.node(step);
  const std::uint8_t bits = choice_bits(step, choice::kExplicit | choice::kPoll);
  world.scanner.allocate(mac_id, bits, other_master(step));
}

void release(CanWorld& world, TableReader& step) {
  const std::uint8_t mac_id = world.node(step);
  const std::uint8_t bits = choice_bits(step, choice::kExplicit | choice::kPoll);
  const bool stop = step.boolean("stop_polling", true);
  Scanner::Options options = request_options(step);
  options.unconnected = true;
  world.scanner.request(mac_id, ByteVector{service::kRelease, 0x03, 0x01, bits}, options);
  if (stop && (bits & choice::kPoll) != 0) world.scanned(mac_id).polled = false;
}

void set_packet_rate(CanWorld& world, TableReader& step) {
  const std::uint8_t mac_id = world.node(step);
  const auto connection = step.choice<std::uint8_t>("connection", 2, {{"explicit", 1}, {"poll", 2}});
  const auto epr_ms = static_cast<std::uint16_t>(step.integer("ms", 0, 0xFFFF));
  world.scanner.set_packet_rate(mac_id, connection, epr_ms);
}

// What a scanner does with a slave of its list: from power-up to the first polls.
void connect(CanWorld& world, TableReader& step) {
  const std::uint8_t mac_id = world.node(step);
  const bool from_power_up = step.boolean("power_up", true);
  const auto epr_ms = static_cast<std::uint16_t>(step.integer("epr_ms", 100, 0, 0xFFFF));
  const bool identify = step.boolean("identify", false);
  Slave& slave = *world.slave(mac_id);
  if (from_power_up) {
    slave.power_up();
    world.bus.run(world.bus.now_ns() + kBootNs);
  }
  world.scanner.allocate(mac_id, choice::kExplicit | choice::kPoll);
  if (identify) {
    constexpr std::uint8_t kAttributes[] = {1, 2, 3, 7};
    for (const std::uint8_t attribute : kAttributes)
      world.scanner.request(mac_id, ByteVector{service::kGetAttributeSingle, 0x01, 0x01, attribute});
  }
  world.scanner.set_packet_rate(mac_id, 2, epr_ms);
  world.scanned(mac_id).polled = true;
  world.scanner.poll(mac_id, 2);
}

void get_attribute(CanWorld& world, TableReader& step) {
  const std::uint8_t mac_id = world.node(step);
  const ByteVector message{service::kGetAttributeSingle, small(step, "class"), small(step, "instance", 1),
                           small(step, "attribute")};
  world.scanner.request(mac_id, message, request_options(step));
}

void set_attribute(CanWorld& world, TableReader& step) {
  const std::uint8_t mac_id = world.node(step);
  ByteVector message{service::kSetAttributeSingle, small(step, "class"), small(step, "instance", 1),
                     small(step, "attribute")};
  if (step.has("data")) {
    const ByteVector data = step.bytes("data");
    message.insert(message.end(), data.begin(), data.end());
  } else {
    const std::int64_t value = step.integer("value", INT32_MIN, UINT32_MAX);
    const std::int64_t size = step.integer("size", 4, 1, 4);
    for (std::int64_t i = 0; i < size; ++i)
      message.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xFFU));
  }
  world.scanner.request(mac_id, message, request_options(step));
}

void request_service(CanWorld& world, TableReader& step) {
  const std::uint8_t mac_id = world.node(step);
  ByteVector message{small(step, "service"), small(step, "class"), small(step, "instance", 1)};
  if (step.has("data")) {
    const ByteVector data = step.bytes("data");
    message.insert(message.end(), data.begin(), data.end());
  }
  world.scanner.request(mac_id, message, request_options(step));
}

void reset(CanWorld& world, TableReader& step) {
  const std::uint8_t mac_id = world.node(step);
  const bool wait = step.boolean("wait", true);
  world.scanner.request(mac_id, ByteVector{service::kReset, 0x01, 0x01});
  if (wait) {
    world.scanned(mac_id).polled = false;
    world.bus.run(world.bus.now_ns() + kBootNs + 100 * kMillisecondNs);
  }
}

void poll(CanWorld& world, TableReader& step) {
  const std::uint8_t mac_id = world.node(step);
  const auto cycles = static_cast<std::uint64_t>(step.integer("cycles", 1, 1, 100'000));
  world.scanned(mac_id).polled = true;
  world.scanner.poll(mac_id, cycles);
}

void stop_polling(CanWorld& world, TableReader& step) { world.scanned(world.node(step)).polled = false; }

void idle(CanWorld& world, TableReader& step) {
  const std::uint8_t mac_id = world.node(step);
  const auto polls = static_cast<unsigned>(step.integer("polls", 1, 1, 1000));
  world.scanned(mac_id).idle_polls = polls;
  world.scanner.poll(mac_id, polls);
}

void wait(CanWorld& world, TableReader& step) {
  const DurationNs duration_ns = step.milliseconds("ms", 0);
  world.bus.run(world.bus.now_ns() + duration_ns);
}

void period(CanWorld& world, TableReader& step) {
  const DurationNs period_ns = step.milliseconds("ms", 10 * kMillisecondNs);
  if (period_ns < 500 * kMicrosecondNs) {
    step.fail("ms", "\"ms\" must be 0.5 or more");
    return;
  }
  world.scanner.set_period(period_ns);
}

void record(CanWorld& world, TableReader& step) { world.bus.recording = step.boolean("on", true); }

void poll_data(CanWorld& world, TableReader& step) {
  const std::uint8_t mac_id = world.node(step);
  world.scanned(mac_id).command = step.bytes("data");
  const auto cycles = static_cast<std::uint64_t>(step.integer("polls", 1, 0, 1000));
  if (cycles > 0) world.scanner.poll(mac_id, cycles);
}

// A frame from outside: of another device, or of none.
void send(CanWorld& world, TableReader& step) {
  CanFrame frame = can_frame(static_cast<std::uint32_t>(step.integer("id", 0, 0x1FFFFFFF)),
                             step.has("data") ? step.bytes("data") : ByteVector{});
  frame.extended = step.boolean("extended", false);
  frame.remote = step.boolean("remote", false);
  if (frame.remote) frame.length = static_cast<std::uint8_t>(step.integer("length", 0, 0, 8));
  const auto times = step.integer("times", 1, 1, 10'000);
  const DurationNs every_ns = step.milliseconds("every_ms", kMillisecondNs);
  for (std::int64_t i = 0; i < times; ++i) {
    world.bus.send(nullptr, frame);
    world.bus.run(world.bus.now_ns() + every_ns);
  }
}

constexpr CanStep kSteps[] = {
    {"connect", connect},
    {"power_up", power_up},
    {"power_up_twin", power_up_twin},
    {"power_off", power_off},
    {"was_running", was_running},
    {"allocate", allocate},
    {"release", release},
    {"set_epr", set_packet_rate},
    {"get_attribute", get_attribute},
    {"set_attribute", set_attribute},
    {"service", request_service},
    {"reset", reset},
    {"poll", poll},
    {"stop_polling", stop_polling},
    {"idle", idle},
    {"wait", wait},
    {"period", period},
    {"record", record},
    {"poll_data", poll_data},
    {"send", send},
};

}  // namespace

std::span<const CanStep> link_steps() { return kSteps; }

}  // namespace servotrace::simulator
