// SPDX-License-Identifier: MIT
// [[ring]]: a controller and its axes, recorded cycle by cycle.
#include <algorithm>
#include <array>
#include <cstdio>
#include <deque>
#include <memory>

#include "captures/simulator/bus.hpp"
#include "captures/simulator/rtex_master.hpp"
#include "captures/simulator/rtex_record_writer.hpp"

namespace servotrace::simulator {
namespace {

using namespace ring;
using servotrace::rtex::Carrier;

constexpr std::int64_t kLongestRing = 400'000;  // communication cycles
constexpr std::size_t kMostBlocks = 32;         // of the ASIC's memories (4-1)

struct Axis {
  std::unique_ptr<A5nDrive> drive;
  std::unique_ptr<AxisMaster> master;
  std::size_t offset = 0;  // of its blocks in the memories
  std::size_t size = 0;
  int counter = 0;  // Update_Counter sent last
};

struct RingConfig {
  Timing timing;
  std::uint8_t number = 0;
  Carrier carrier = Carrier::kExportedPdu;
  std::uint32_t interface_id = 0;
  DurationNs start_ns = 0;
  std::int64_t nop_cycles = 20;
  std::int64_t tail_cycles = 20;
  bool sequence_valid = true;
  bool cycle_valid = true;
  std::uint32_t first_sequence = 0;
  std::int64_t sample_every = 1;
  bool sampled = false;
  std::int64_t record_from = 0;  // cycle
  std::int64_t jitter_ns = 0;
  std::int64_t restart_cycles = 40;  // between the loss of a ring and its new start
  std::size_t late_responses = 0;    // cycles by which the recorder reads the reception memory too early
  std::int64_t lost_cycles = 6;      // cycles without a response after which the master sees that the ring is lost
};

Timing read_timing(TableReader& reader) {
  Timing timing;
  const double cycle_us = reader.optional_number("cycle_us").value_or(500.0);
  struct Row {
    double us;
    std::int64_t cycles_per_second;
    std::uint32_t cycle_ns;
  };
  static constexpr Row kRows[] = {
      {83.333, 12'000, 83'333}, {166.667, 6'000, 166'667}, {500.0, 2'000, 500'000}, {1000.0, 1'000, 1'000'000}};
  const auto* row =
      std::find_if(std::begin(kRows), std::end(kRows), [&](const Row& entry) { return entry.us == cycle_us; });
  if (row == std::end(kRows)) {
    reader.fail("cycle_us", "\"cycle_us\" must be 83.333, 166.667, 500 or 1000");
  } else {
    timing.cycles_per_second = row->cycles_per_second;
    timing.cycle_ns = row->cycle_ns;
  }
  timing.ratio = static_cast<int>(reader.integer("ratio", timing.cycles_per_second == 12'000 ? 2 : 1, 1, 2));
  timing.full_sync = reader.boolean("full_sync", false);
  return timing;
}

std::optional<Sensor> read_sensor(TableReader& reader, std::string_view key) {
  const toml::array* range = reader.array(key);
  if (range == nullptr) return std::nullopt;
  const auto* from = range->size() == 2 ? range->get(0)->as_integer() : nullptr;
  const auto* to = range->size() == 2 ? range->get(1)->as_integer() : nullptr;
  if (from == nullptr || to == nullptr) {
    reader.fail(key, "a sensor is [from, to], in command units");
    return std::nullopt;
  }
  return Sensor{static_cast<std::int32_t>(from->get()), static_cast<std::int32_t>(to->get())};
}

DriveConfig read_drive(TableReader& reader) {
  DriveConfig config;
  config.mac_id = static_cast<std::uint8_t>(reader.integer("mac_id", 0, 31));
  config.wide = reader.integer("data_size", 16, 16, 32) == 32;
  config.absolute = reader.boolean("absolute", false);
  config.full_closed = reader.boolean("full_closed", false);
  config.position = static_cast<std::int32_t>(reader.integer("position", 0, INT32_MIN, INT32_MAX));
  config.servo_on_ns = reader.milliseconds("servo_on_ms", config.servo_on_ns);
  config.ready_ns = reader.milliseconds("ready_ms", config.ready_ns);
  config.home = read_sensor(reader, "home");
  config.pot = read_sensor(reader, "pot");
  config.not_ = read_sensor(reader, "not");
  config.model = reader.text("model", config.model);
  config.serial = reader.text("serial", config.serial);
  config.warning = static_cast<std::uint8_t>(reader.integer("warning", 0, 0, 255));
  config.alarm.main = static_cast<std::uint8_t>(reader.integer("alarm", 0, 0, 255));
  if (const toml::table* parameters = reader.table("parameters")) {
    TableReader entries(*parameters, reader.problems());
    for (const auto& [key, node] : *parameters) {
      unsigned parameter_class = 0;
      unsigned number = 0;
      const std::string name(key.str());
      const int fields = std::sscanf(name.c_str(), "%1u.%2u", &parameter_class, &number);
      if (fields != 2) entries.fail(name, "a parameter is named by class and number, like \"7.23\"");
      config.parameters[static_cast<std::uint16_t>(parameter_class << 8U | number)] =
          static_cast<std::int32_t>(entries.integer(name, INT32_MIN, INT32_MAX));
    }
    entries.done();
  }
  return config;
}

int read_first_mode(TableReader& reader) {
  return reader.choice<int>("mode", kCp, {{"pp", kPp}, {"cp", kCp}, {"cv", kCv}, {"ct", kCt}});
}

class RingSimulation {
 public:
  explicit RingSimulation(const BusJob& job) : job_(job) {}

  void run() {
    read();
    if (!job_.problems.any()) simulate();
  }

 private:
  void read();
  void simulate();
  void update_counters();
  void make_commands();
  void exchange(std::int64_t cycle);
  bool apply(std::int64_t cycle, bool of_command, MutableBytes memory);
  void record(std::int64_t cycle, bool response, TimeNs time_ns);
  bool any(FaultKind kind) const;
  const Fault* find(FaultKind kind, int mac_id) const;
  const Fault* find_record(FaultKind kind, bool response) const;
  TimeNs time_of(std::int64_t cycle, bool response);
  bool in_nop() const { return ring_.cycle - nop_from_ < config_.nop_cycles; }
  bool is_update() const { return (ring_.cycle - nop_from_) % config_.timing.ratio == 0; }

  const BusJob& job_;
  RingConfig config_;
  std::vector<Axis> axes_;
  RingState ring_;
  std::vector<std::uint8_t> commands_;
  std::vector<std::uint8_t> responses_;
  std::deque<std::vector<std::uint8_t>> recorded_responses_;  // the newest last
  std::int64_t nop_from_ = 0;                                 // the cycle in which the ring was initialised last
  bool resetting_ = false;
  std::int64_t reset_cycle_ = 0;
  std::uint32_t noise_ = 12345;
};

void RingSimulation::read() {
  TableReader reader(job_.table, job_.problems);
  RingConfig& config = config_;
  config.timing = read_timing(reader);
  config.number = static_cast<std::uint8_t>(reader.integer("ring", 0, 0, 255));
  config.carrier = reader.choice<Carrier>("carrier", Carrier::kExportedPdu,
                                          {{"pdu", Carrier::kExportedPdu},
                                           {"ethernet", Carrier::kEthernet},
                                           {"udp", Carrier::kUdp},
                                           {"user0", Carrier::kUserLink}});
  const std::string name = reader.text("interface", "rtex" + std::to_string(job_.index));
  config.interface_id = job_.recording.interface(link_type_of(config.carrier), name);
  config.start_ns = reader.milliseconds("start_ms", 0);
  config.nop_cycles = reader.integer("nop_cycles", 20, 0, 100'000) / config.timing.ratio * config.timing.ratio;
  config.tail_cycles = reader.integer("tail_cycles", 20, 0, 100'000);
  config.sequence_valid = reader.boolean("sequence", true);
  config.cycle_valid = reader.boolean("cycle_in_header", true);
  config.first_sequence = static_cast<std::uint32_t>(reader.integer("first_sequence", 0, 0, UINT32_MAX));
  config.sample_every = reader.integer("sample_every", 1, 1, 10'000);
  config.sampled = reader.boolean("sampled", config.sample_every > 1);
  const auto cycles = [&](DurationNs time_ns) { return time_ns * config.timing.cycles_per_second / kSecondNs; };
  config.record_from = cycles(reader.milliseconds("record_from_ms", 0));
  config.jitter_ns = reader.microseconds("jitter_us", 1'000);
  config.late_responses = static_cast<std::size_t>(reader.integer("late_responses", 0, 0, 3));
  config.restart_cycles = cycles(reader.milliseconds("restart_ms", 20'000'000));

  std::size_t offset = 0;
  for (const toml::table* table : reader.tables("axis")) {
    TableReader entry(*table, job_.problems);
    Axis axis;
    axis.drive = std::make_unique<A5nDrive>(read_drive(entry), config.timing);
    axis.master = std::make_unique<AxisMaster>(*axis.drive, config.timing, read_first_mode(entry));
    axis.offset = offset;
    axis.size = axis.drive->config().wide ? kWideBlock : kBlock;
    offset += axis.size;
    entry.done();
    axes_.push_back(std::move(axis));
  }
  if (axes_.empty()) reader.fail("axis", "a ring needs an [[ring.axis]] table");
  if (offset > kMostBlocks * kBlock) reader.fail("axis", "more blocks than the 32 of the ASIC's memories");
  commands_.assign(offset, 0);
  responses_.assign(offset, 0);

  for (const toml::table* table : reader.tables("fault"))
    ring_.faults.push_back(read_fault(*table, job_.problems, config.timing.cycles_per_second, false));
  std::vector<Step> steps;
  for (const toml::table* table : reader.tables("step"))
    read_step(*table, job_.problems, config.timing.cycles_per_second, steps);
  for (const Step& step : steps) {
    bool taken = false;
    for (Axis& axis : axes_) {
      if (step.axis >= 0 && step.axis != axis.drive->config().mac_id) continue;
      axis.master->add(step);
      taken = true;
    }
    if (!taken) job_.problems.add(step.where, "no axis has the MAC-ID " + std::to_string(step.axis));
  }
  reader.done();
}

const Fault* RingSimulation::find(FaultKind kind, int mac_id) const {
  for (const Fault& fault : ring_.faults) {
    if (fault.kind == kind && fault.acts(ring_.cycle, mac_id)) return &fault;
  }
  return nullptr;
}

const Fault* RingSimulation::find_record(FaultKind kind, bool response) const {
  for (const Fault& fault : ring_.faults) {
    const bool meant = fault.records == Records::kBoth || (fault.records == Records::kResponse) == response;
    if (fault.kind == kind && meant && fault.acts(ring_.cycle)) return &fault;
  }
  return nullptr;
}

bool RingSimulation::any(FaultKind kind) const {
  return std::any_of(ring_.faults.begin(), ring_.faults.end(),
                     [&](const Fault& fault) { return fault.kind == kind && fault.acts(ring_.cycle); });
}

// 4-2-2-1: 1 with the first valid data, then one more each updating cycle.
void RingSimulation::update_counters() {
  for (Axis& axis : axes_) {
    const int mac_id = axis.drive->config().mac_id;
    const Fault* set = find(FaultKind::kCounterSet, mac_id);
    const Fault* skip = find(FaultKind::kCounterSkip, mac_id);
    if (set != nullptr) {
      axis.counter = static_cast<int>(set->value);
    } else if (is_update() && find(FaultKind::kCounterStuck, mac_id) == nullptr) {
      axis.counter += skip != nullptr ? static_cast<int>(skip->value) : 1;
    } else if (!is_update() && find(FaultKind::kCounterEarly, mac_id) != nullptr) {
      ++axis.counter;
    }
    axis.counter %= 4;
  }
}

void RingSimulation::make_commands() {
  if (in_nop()) {
    std::fill(commands_.begin(), commands_.end(), std::uint8_t{0});
    for (Axis& axis : axes_) {
      axis.counter = 0;
      const MutableBytes block = MutableBytes(commands_).subspan(axis.offset, axis.size);
      put(command::kMacId, block, axis.drive->config().mac_id);
      if (axis.size == kWideBlock) put(command::kSubChk, block, 1);
    }
    return;
  }
  ring_.all_reset_echoed =
      std::all_of(axes_.begin(), axes_.end(), [](const Axis& axis) { return axis.master->echoes_reset(); });
  ring_.slowest_sync = axes_.front().master->syncs_reached();
  for (const Axis& axis : axes_) ring_.slowest_sync = std::min(ring_.slowest_sync, axis.master->syncs_reached());
  if (is_update()) {
    for (Axis& axis : axes_) axis.master->update(ring_);
  }
  update_counters();
  const std::int64_t half_ms = ring_.cycle * 2000 / config_.timing.cycles_per_second;
  for (Axis& axis : axes_) {
    const MutableBytes block = MutableBytes(commands_).subspan(axis.offset, axis.size);
    axis.master->fill(block);
    put(command::kUpdateCounter, block, axis.counter);
    if (config_.timing.full_sync) put(command::kTmgCnt, block, half_ms / 4 % 2);  // toggles every 2 ms (4-2-1-1)
  }
}

// The faults of fields and bytes, in the order they are written down.
bool RingSimulation::apply(std::int64_t cycle, bool of_command, MutableBytes memory) {
  for (const Fault& fault : ring_.faults) {
    const bool of_field = fault.kind == (of_command ? FaultKind::kCommandField : FaultKind::kResponseField);
    const bool of_byte = fault.kind == (of_command ? FaultKind::kCommandByte : FaultKind::kResponseByte);
    if (!of_field && !of_byte) continue;
    for (Axis& axis : axes_) {
      if (!fault.acts(cycle, axis.drive->config().mac_id)) continue;
      const MutableBytes block = memory.subspan(axis.offset, axis.size);
      const unsigned last = of_field ? fault.field.first_byte + fault.field.byte_count - 1U : fault.byte;
      if (last >= block.size()) continue;
      put(of_field ? fault.field : whole_byte(fault.byte), block, fault.value);
    }
  }
  return true;
}

// One cycle at the drives: the response memory is filled, then the commands are taken.
void RingSimulation::exchange(std::int64_t cycle) {
  for (Axis& axis : axes_) {
    const int mac_id = axis.drive->config().mac_id;
    const MutableBytes response = MutableBytes(responses_).subspan(axis.offset, axis.size);
    const Bytes command = Bytes(commands_).subspan(axis.offset, axis.size);
    axis.drive->hold_echo(find(FaultKind::kHoldEcho, mac_id) != nullptr);
    if (find(FaultKind::kFrozen, mac_id) == nullptr) axis.drive->respond(response);
    if (find(FaultKind::kSilent, mac_id) != nullptr) std::fill(response.begin(), response.end(), std::uint8_t{0});
    if (find(FaultKind::kCrcError, mac_id) != nullptr) {
      axis.drive->receive_broken();
    } else {
      axis.drive->receive(command);
    }
  }
  apply(cycle, false, responses_);
  recorded_responses_.push_back(responses_);
  if (recorded_responses_.size() > config_.late_responses + 1) recorded_responses_.pop_front();
  for (Axis& axis : axes_) axis.master->observe(Bytes(responses_).subspan(axis.offset, axis.size));
}

// The command a little after the cycle's start, by the operating system's jitter; the response an eighth of a cycle on.
TimeNs RingSimulation::time_of(std::int64_t cycle, bool response) {
  noise_ = noise_ * 1'664'525U + 1'013'904'223U;
  const std::int64_t jitter = config_.jitter_ns == 0 ? 0 : static_cast<std::int64_t>(noise_ >> 8U) % config_.jitter_ns;
  TimeNs time_ns = job_.start_ns + config_.start_ns + config_.timing.start_of(cycle) + jitter;
  if (const Fault* late = find(FaultKind::kLate, -1)) time_ns += late->value * kMicrosecondNs;
  return response ? time_ns + config_.timing.cycle_ns / 8 : time_ns;
}

void RingSimulation::record(std::int64_t cycle, bool response, TimeNs time_ns) {
  if (cycle < config_.record_from || cycle % config_.sample_every != 0) return;
  if (find_record(FaultKind::kDrop, response) != nullptr) return;
  RecordHeader header{.response = response,
                      .sequence_valid = config_.sequence_valid,
                      .cycle_valid = config_.cycle_valid,
                      .sampled = config_.sampled,
                      .ring = config_.number,
                      .sequence = config_.first_sequence + static_cast<std::uint32_t>(cycle),
                      .cycle_ns = config_.cycle_valid ? config_.timing.cycle_ns : 0,
                      .node_count = static_cast<std::uint8_t>(axes_.size())};
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (axes_[i].size == kWideBlock) header.wide_nodes |= 1U << i;
  }
  std::vector<std::uint8_t> bytes = make_record(header, response ? recorded_responses_.front() : commands_);
  for (const Fault& fault : ring_.faults) {
    const bool meant = fault.records == Records::kBoth || (fault.records == Records::kResponse) == response;
    if (fault.kind == FaultKind::kHeaderByte && meant && fault.acts(cycle))
      bytes[fault.byte] = static_cast<std::uint8_t>(fault.value);
  }
  std::vector<std::uint8_t> frame = wrap_record(config_.carrier, bytes);
  const auto length = static_cast<std::uint32_t>(frame.size());
  if (const Fault* cut = find_record(FaultKind::kCut, response))
    frame.resize(std::min<std::size_t>(frame.size(), static_cast<std::size_t>(cut->value)));
  TimeNs stamp_ns = time_ns;
  if (const Fault* stamp = find_record(FaultKind::kStamp, response)) stamp_ns -= stamp->value * kMicrosecondNs;
  const int times = find_record(FaultKind::kRepeat, response) != nullptr ? 2 : 1;
  for (int i = 0; i < times; ++i) job_.recording.add_stamped(config_.interface_id, time_ns, stamp_ns, frame, length);
}

void RingSimulation::simulate() {
  std::int64_t idle_cycles = 0;
  std::int64_t cycle = 0;       // of the ring: what the master counts
  std::int64_t wall_cycle = 0;  // what passes on the clock
  while (idle_cycles <= config_.tail_cycles) {
    if (wall_cycle > kLongestRing) {
      job_.problems.add(job_.table.source(),
                        "the ring is not done after 400000 communication cycles, the most a scenario "
                        "may take; a step waits for what never comes, or the steps are too long");
      return;
    }
    ring_.cycle = wall_cycle;
    ring_.now_ns = config_.timing.start_of(wall_cycle);
    if (any(FaultKind::kStall)) {
      ++wall_cycle;
      continue;
    }
    if (any(FaultKind::kInitialise)) {
      nop_from_ = wall_cycle;
      for (Axis& axis : axes_) axis.master->start_again();
    }
    make_commands();
    for (const Axis& axis : axes_) {
      if (const Step* step = axis.master->overdue(ring_.now_ns)) {
        job_.problems.add(step->where, "axis " + std::to_string(axis.drive->config().mac_id) +
                                           " waits in vain for the end of this step");
        return;
      }
    }
    apply(wall_cycle, true, commands_);
    record(cycle, false, time_of(wall_cycle, false));
    exchange(wall_cycle);
    const bool lost = std::any_of(axes_.begin(), axes_.end(), [](const Axis& axis) { return axis.drive->in_reset(); });
    if (!lost) {
      record(cycle, true, time_of(wall_cycle, true));
      resetting_ = false;
    } else if (!resetting_) {
      resetting_ = true;
      reset_cycle_ = wall_cycle;
    } else if (wall_cycle - reset_cycle_ >= config_.lost_cycles) {
      // 6-3-1: the master sees the time-out, waits, and initialises the communication again.
      for (Axis& axis : axes_) {
        if (axis.drive->in_reset()) axis.drive->restart();
        axis.master->start_again();
      }
      resetting_ = false;
      wall_cycle += config_.restart_cycles;
      nop_from_ = wall_cycle + 1;
    }
    const bool idle = std::all_of(axes_.begin(), axes_.end(), [](const Axis& axis) { return axis.master->idle(); });
    idle_cycles = idle ? idle_cycles + 1 : 0;
    ++cycle;
    ++wall_cycle;
  }
}

}  // namespace

void simulate_ring(const BusJob& job) { RingSimulation(job).run(); }

}  // namespace servotrace::simulator
