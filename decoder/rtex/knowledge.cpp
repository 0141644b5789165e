// SPDX-License-Identifier: MIT
#include "decoder/rtex/knowledge.hpp"

namespace servotrace::rtex {
namespace {

std::int32_t part(const FactRow& row, std::int32_t value) {
  return row.bit < 0 ? value : static_cast<std::int32_t>(static_cast<std::uint32_t>(value) >> row.bit & 1U);
}

}  // namespace

Knowledge::Knowledge() {
  for (std::size_t i = 0; i < kFactCount; ++i) {
    if (kFacts[i].assumed) known_[i].basis.kind = BasisKind::kAssumed;
  }
}

void Knowledge::configure(const RtexAxisSettings& axis) {
  const auto set = [this](Fact fact, std::int32_t value) {
    known_[static_cast<std::size_t>(fact)] = {value, {BasisKind::kConfigured, 0}};
  };
  for (std::size_t i = 0; i < kFactCount; ++i) {
    const auto found = axis.parameters.find(kFacts[i].index);
    if (found != axis.parameters.end()) set(static_cast<Fact>(i), part(kFacts[i], found->second));
  }
  if (axis.full_closed) set(Fact::kFullClosed, *axis.full_closed ? 6 : 0);
  if (axis.data_size) set(Fact::kWideBlocks, *axis.data_size == 32 ? 1 : 0);
}

void Knowledge::learn(std::uint16_t index, std::int32_t value, std::uint64_t frame) {
  for (std::size_t i = 0; i < kFactCount; ++i) {
    if (kFacts[i].index != index || known_[i].basis.kind == BasisKind::kConfigured) continue;
    known_[i] = {part(kFacts[i], value), {BasisKind::kCapture, frame}};
  }
}

void Knowledge::forget(std::uint16_t index) {
  for (std::size_t i = 0; i < kFactCount; ++i) {
    if (kFacts[i].index == index && known_[i].basis.kind != BasisKind::kConfigured) known_[i] = {};
  }
}

void Knowledge::on_read(std::uint16_t index, std::int32_t value, std::uint64_t frame) {
  if (!is_pending(index)) learn(index, value, frame);
}

bool Knowledge::is_pending(std::uint16_t index) const {
  for (const Waiting& entry : waiting()) {
    const bool acts = entry.attribute == Attribute::kA || entry.attribute == Attribute::kB;
    if (entry.index == index && !acts) return true;
  }
  return false;
}

void Knowledge::on_attribute(std::uint16_t index, Attribute attribute) {
  for (ParameterAttribute& entry : attributes_) {
    if (entry.index != index) continue;
    entry.attribute = attribute;
    return;
  }
  attributes_.push_back({index, attribute});  // past the last place: as the manual prints it
}

Attribute Knowledge::attribute(std::uint16_t index) const {
  for (const ParameterAttribute& entry : attributes_) {
    if (entry.index == index) return entry.attribute;
  }
  return attribute_of(index);
}

void Knowledge::on_write(std::uint16_t index, std::int32_t value, Attribute attribute, std::uint64_t frame) {
  std::size_t place = 0;
  while (place < waiting_count_ && waiting_[place].index != index) ++place;
  if (attribute == Attribute::kA || attribute == Attribute::kB) learn(index, value, frame);
  // When a value of unknown attribute acts is not known: until a reset it may be either.
  if (attribute == Attribute::kUnknown) forget(index);
  if (unsaved_.count++ == 0) unsaved_ = {1, index, frame};
  if (place == kMaxWaiting) return;
  waiting_[place] = {index, value, attribute, frame, false, false};
  if (place == waiting_count_) ++waiting_count_;
}

void Knowledge::on_eeprom_write() {
  for (std::size_t i = 0; i < waiting_count_; ++i) waiting_[i].in_eeprom = true;
  unsaved_ = {};
}

void Knowledge::on_validation() {
  for (std::size_t i = 0; i < waiting_count_;) {
    if (waiting_[i].attribute != Attribute::kC) {
      ++i;
      continue;
    }
    learn(waiting_[i].index, waiting_[i].value, waiting_[i].frame);
    waiting_[i] = waiting_[--waiting_count_];
  }
}

void Knowledge::on_reset() {
  for (std::size_t i = 0; i < waiting_count_; ++i) {
    const Waiting& entry = waiting_[i];
    const bool acted = entry.attribute == Attribute::kA || entry.attribute == Attribute::kB;
    if (entry.in_eeprom) {
      learn(entry.index, entry.value, entry.frame);
    } else if (acted) {
      forget(entry.index);  // what the EEPROM holds is not known
    }
  }
  waiting_count_ = 0;
  unsaved_ = {};
}

void Knowledge::on_lost() {
  for (std::size_t i = 0; i < waiting_count_; ++i) waiting_[i].lost = true;
  unsaved_ = {};
}

void Knowledge::prove(Fact fact, std::int32_t value, std::uint64_t frame) {
  Known& known = known_[static_cast<std::size_t>(fact)];
  if (known.basis.kind != BasisKind::kConfigured) known = {value, {BasisKind::kCapture, frame}};
}

BlockFormat Knowledge::format() const {
  BlockFormat format;
  const auto small = [this](Fact fact) -> std::uint8_t {
    const std::int32_t value = (*this)[fact].value;
    return value > 0 && value <= 0xFF ? static_cast<std::uint8_t>(value) : std::uint8_t{0};
  };
  for (std::size_t i = 0; i < format.monitor.size(); ++i)
    format.monitor[i] = small(static_cast<Fact>(static_cast<std::size_t>(Fact::kMonitor1) + i));
  for (std::size_t i = 0; i < format.feedforward.size(); ++i)
    format.feedforward[i] = small(static_cast<Fact>(static_cast<std::size_t>(Fact::kForward1) + i));
  format.speed_in_units = (*this)[Fact::kSpeedUnit].value == 1;
  format.limits_swapped = (*this)[Fact::kLimitsSwapped].value == 1;
  const Known& swapped = (*this)[Fact::kInhibitSwapped];
  const Known& ac_off = (*this)[Fact::kAcOff];
  format.status_known = swapped.certain() && ac_off.certain();
  format.inhibit_swapped = format.status_known && swapped.value == 1;
  format.ac_off = format.status_known && ac_off.value == 1;
  return format;
}

}  // namespace servotrace::rtex
