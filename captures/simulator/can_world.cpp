// SPDX-License-Identifier: MIT
#include "captures/simulator/can_world.hpp"

#include "captures/simulator/can_esb.hpp"
#include "captures/simulator/can_ns310.hpp"

namespace servotrace::simulator {

CanWorld::CanWorld(const BusJob& bus_job, std::uint32_t bit_rate, std::uint8_t master_mac_id, DurationNs period_ns,
                   DurationNs delay_ns)
    : job(bus_job), bus(bit_rate, bus_job.start_ns + delay_ns), scanner(bus, master_mac_id, period_ns) {
  bus.tamper = [this](CanFrame& frame) { return pass(frame); };
}

Fate CanWorld::pass(CanFrame& frame) {
  for (Tampering& entry : tamperings) {
    if (entry.count == 0 || frame.error || frame.extended || frame.identifier != entry.identifier) continue;
    if (entry.fragment && (frame.length == 0 || (frame.data[0] & fragment::kCountMask) != *entry.fragment)) continue;
    if (entry.skip > 0) {
      --entry.skip;
      continue;
    }
    --entry.count;
    if (entry.length) frame.length = *entry.length;
    if (entry.byte && *entry.byte < frame.length) {
      std::uint8_t& byte = frame.data[*entry.byte];
      byte = static_cast<std::uint8_t>((byte & ~entry.clear) | entry.set);
    }
    if (entry.fate != Fate::kSent) return entry.fate;
  }
  return Fate::kSent;
}

Slave* CanWorld::slave(std::uint8_t mac_id) {
  for (const std::unique_ptr<Slave>& entry : slaves) {
    if (entry->settings().mac_id == mac_id) return entry.get();
  }
  return nullptr;
}

std::uint8_t CanWorld::node(TableReader& reader) {
  const std::uint8_t first = slaves.empty() ? 0 : slaves.front()->settings().mac_id;
  const auto mac_id = static_cast<std::uint8_t>(reader.integer("node", first, 0, 63));
  if (slave(mac_id) != nullptr) return mac_id;
  reader.fail("node", "there is no node " + std::to_string(mac_id));
  return first;
}

Ns310* CanWorld::ns310(TableReader& reader) {
  auto* drive = dynamic_cast<Ns310*>(slave(node(reader)));
  if (drive == nullptr) reader.fail("node", "this node is no NS310");
  return drive;
}

Esb* CanWorld::esb(TableReader& reader) {
  auto* drive = dynamic_cast<Esb*>(slave(node(reader)));
  if (drive == nullptr) reader.fail("node", "this node is no ESB");
  return drive;
}

bool CanWorld::poll_until(std::uint8_t mac_id, Slot signal, std::int64_t wanted, unsigned limit) {
  Scanner::Node& to = scanned(mac_id);
  for (unsigned i = 0; i < limit; ++i) {
    to.response.reset();
    scanner.poll(mac_id, 1);
    if (to.response && to.response->size() >= std::size_t{signal.first_byte} + signal.byte_count &&
        read(signal, *to.response) == wanted)
      return true;
  }
  return false;
}

}  // namespace servotrace::simulator
