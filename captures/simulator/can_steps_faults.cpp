// SPDX-License-Identifier: MIT
// Steps that put faults in: into frames on their way, into what a slave answers, onto the wire. Each acts from where it
// stands on.
#include "captures/simulator/can_world.hpp"

namespace servotrace::simulator {
namespace {

enum class FrameKind : std::uint8_t { kCommand, kResponse, kRequest, kAnswer, kUnconnected, kMacCheck };

std::uint32_t identifier_of(FrameKind kind, std::uint32_t mac_id) {
  switch (kind) {
    case FrameKind::kCommand:
      return 0x405U + 8U * mac_id;
    case FrameKind::kResponse:
      return 0x3C0U + mac_id;
    case FrameKind::kRequest:
      return 0x404U + 8U * mac_id;
    case FrameKind::kAnswer:
      return 0x403U + 8U * mac_id;
    case FrameKind::kUnconnected:
      return 0x406U + 8U * mac_id;
    case FrameKind::kMacCheck:
      return 0x407U + 8U * mac_id;
  }
  return 0;
}

Tampering matching(CanWorld& world, TableReader& step) {
  const std::uint8_t mac_id = world.node(step);
  const FrameKind kind = step.choice<FrameKind>("frame", FrameKind::kResponse,
                                                {{"command", FrameKind::kCommand},
                                                 {"response", FrameKind::kResponse},
                                                 {"request", FrameKind::kRequest},
                                                 {"answer", FrameKind::kAnswer},
                                                 {"unconnected", FrameKind::kUnconnected},
                                                 {"mac_check", FrameKind::kMacCheck}});
  Tampering entry;
  entry.identifier = identifier_of(kind, mac_id);
  if (const auto fragment = step.optional_integer("fragment", 0, 63))
    entry.fragment = static_cast<std::uint8_t>(*fragment);
  entry.skip = static_cast<unsigned>(step.integer("skip", 0, 0, 100'000));
  entry.count = static_cast<unsigned>(step.integer("count", 1, 1, 100'000));
  // A byte of the message of a node whose data travel in fragments lies in a fragment of seven.
  if (const auto byte = step.optional_integer("message_byte", 0, 63)) {
    const bool io = kind == FrameKind::kCommand || kind == FrameKind::kResponse;
    const bool fragments = io && world.scanned(mac_id).fragmented;
    entry.byte = static_cast<std::size_t>(fragments ? *byte % 7 + 1 : *byte);
    if (fragments) entry.fragment = static_cast<std::uint8_t>(*byte / 7);
  }
  return entry;
}

void tamper(CanWorld& world, TableReader& step) {
  Tampering entry = matching(world, step);
  if (const auto byte = step.optional_integer("frame_byte", 0, 7)) entry.byte = static_cast<std::size_t>(*byte);
  entry.set = static_cast<std::uint8_t>(step.integer("set", 0, 0, 255));
  entry.clear = static_cast<std::uint8_t>(step.integer("clear", 0, 0, 255));
  if (const auto length = step.optional_integer("length", 0, 8)) entry.length = static_cast<std::uint8_t>(*length);
  world.tamperings.push_back(entry);
}

void lose(CanWorld& world, TableReader& step) {
  Tampering entry = matching(world, step);
  entry.fate = step.choice<Fate>(
      "how", Fate::kLost, {{"lost", Fate::kLost}, {"unheard", Fate::kUnheard}, {"unrecorded", Fate::kUnrecorded}});
  world.tamperings.push_back(entry);
}

void end_tampering(CanWorld& world, TableReader&) { world.tamperings.clear(); }

void no_response(CanWorld& world, TableReader& step) {
  Slave& slave = *world.slave(world.node(step));
  slave.leave_polls_unanswered = static_cast<unsigned>(step.integer("polls", 1, 1, 100'000));
}

void no_answer(CanWorld& world, TableReader& step) {
  Slave& slave = *world.slave(world.node(step));
  slave.leave_explicit_unanswered = static_cast<unsigned>(step.integer("requests", 1, 1, 100'000));
}

void idle_response(CanWorld& world, TableReader& step) {
  Slave& slave = *world.slave(world.node(step));
  slave.answer_idle = static_cast<unsigned>(step.integer("polls", 1, 1, 100'000));
}

void late_answer(CanWorld& world, TableReader& step) {
  Slave& slave = *world.slave(world.node(step));
  slave.extra_explicit_latency_ns = step.milliseconds("ms", 0);
}

ExplicitReply reply_of(TableReader& step) {
  const auto general = static_cast<std::uint8_t>(step.integer("general", 1, 255));
  const auto additional = static_cast<std::uint8_t>(step.integer("additional", 0xFF, 0, 255));
  return ExplicitReply::error(general, additional);
}

void error_answer(CanWorld& world, TableReader& step) {
  Slave& slave = *world.slave(world.node(step));
  slave.next_reply = reply_of(step);
}

void refuse_allocation(CanWorld& world, TableReader& step) {
  Slave& slave = *world.slave(world.node(step));
  slave.next_allocate_reply = reply_of(step);
}

// Of explicit fragments: the master acknowledges a slave's, the slave a master's.
void bad_acknowledge(CanWorld& world, TableReader& step) {
  Slave& slave = *world.slave(world.node(step));
  const bool by_master = step.choice<bool>("by", true, {{"master", true}, {"slave", false}});
  const auto withhold = static_cast<unsigned>(step.integer("withhold", 0, 0, 100));
  const auto count = step.optional_integer("count", 0, 63);
  const auto wrong_status = step.optional_integer("status", 0, 255);
  (by_master ? world.scanner.withhold_acknowledges : slave.withhold_acknowledges) = withhold;
  auto& counts = by_master ? world.scanner.acknowledge_count : slave.acknowledge_count;
  auto& statuses = by_master ? world.scanner.acknowledge_status : slave.acknowledge_status;
  if (count) counts = static_cast<std::uint8_t>(*count);
  if (wrong_status) statuses = static_cast<std::uint8_t>(*wrong_status);
}

// What Linux reports of a CAN controller: class bits in the identifier, details in the data.
void error_frame(CanWorld& world, TableReader& step) {
  struct Report {
    std::uint32_t classes;
    std::uint8_t controller;  // data byte 1
    std::uint8_t protocol;    // data byte 2
  };
  const Report report = step.choice<Report>("kind", Report{0x88, 0, 0x04},
                                            {{"bus-error", Report{0x88, 0, 0x04}},
                                             {"no-acknowledge", Report{0x20, 0, 0}},
                                             {"error-passive", Report{0x04, 0x10, 0}},
                                             {"bus-off", Report{0x40, 0, 0}},
                                             {"restarted", Report{0x100, 0, 0}},
                                             {"active", Report{0x04, 0x40, 0}},
                                             {"lost-arbitration", Report{0x02, 0, 0}},
                                             {"receive-overflow", Report{0x04, 0x01, 0}}});
  CanFrame frame;
  frame.identifier = report.classes;
  frame.error = true;
  frame.length = 8;
  frame.data[1] = report.controller;
  frame.data[2] = report.protocol;
  const auto times = step.integer("times", 1, 1, 1000);
  for (std::int64_t i = 0; i < times; ++i) {
    world.bus.send(nullptr, frame);
    world.bus.run(world.bus.now_ns() + kMillisecondNs);
  }
}

constexpr CanStep kSteps[] = {
    {"tamper", tamper},
    {"lose", lose},
    {"end_tampering", end_tampering},
    {"no_response", no_response},
    {"no_answer", no_answer},
    {"idle_response", idle_response},
    {"late_answer", late_answer},
    {"error_answer", error_answer},
    {"refuse_allocation", refuse_allocation},
    {"bad_acknowledge", bad_acknowledge},
    {"error_frame", error_frame},
};

}  // namespace

std::span<const CanStep> fault_steps() { return kSteps; }

}  // namespace servotrace::simulator
