// SPDX-License-Identifier: MIT
// What is known of a drive's parameters: from the settings, from reads and writes the capture shows, by proof, or by
// assumption. A written value counts from the moment it acts (SX-DSV02203 6-7-4), never backwards.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "decoder/core/small_vector.hpp"
#include "decoder/findings/finding.hpp"
#include "decoder/pipeline/settings.hpp"
#include "decoder/rtex/decode.hpp"

namespace servotrace::rtex {

// The parameters rules and decoding depend on. Those of bit fields stand once a bit.
enum class Fact : std::uint8_t {
  kFullClosed,       // Pr0.01: 0 semi-closed, 6 full-closed
  kInhibitSetup,     // Pr5.04
  kWarningMask,      // Pr6.38
  kPositiveLimit,    // Pr7.11
  kNegativeLimit,    // Pr7.12
  kCycle,            // Pr7.20
  kRatio,            // Pr7.21
  kWideBlocks,       // Pr7.22 bit 0
  kFullSync,         // Pr7.22 bit 1
  kScaleMonitor,     // Pr7.22 bit 4
  kWriteInhibited,   // Pr7.23 bit 0
  kAlarmSubNumber,   // Pr7.23 bit 1
  kInhibitSilent,    // Pr7.23 bit 2
  kInhibitSwapped,   // Pr7.23 bit 3
  kExtendMode,       // Pr7.23 bit 5
  kInhibitInverted,  // Pr7.23 bit 6
  kLimitsSwapped,    // Pr7.23 bit 7
  kAcOff,            // Pr7.23 bit 8
  kSpeedUnit,        // Pr7.25
  kCounterWarning,   // Pr7.28
  kMonitor1,
  kMonitor2,
  kMonitor3,
  kMonitor4,
  kMonitor5,
  kMonitor6,  // Pr7.29 to Pr7.34
  kForward1,
  kForward2,
  kForward3,      // Pr7.35 to Pr7.37
  kCounterError,  // Pr7.38
  kCount
};
inline constexpr std::size_t kFactCount = static_cast<std::size_t>(Fact::kCount);

struct FactRow {
  Fact fact{};
  std::uint16_t index = 0;  // of the parameter
  std::int8_t bit = -1;     // of the value; -1: the whole of it
  bool assumed = false;     // 0 is assumed where nothing else decides
};

// In the order of Fact.
inline constexpr FactRow kFacts[] = {
    {Fact::kFullClosed, pr(0, 1), -1, true},      {Fact::kInhibitSetup, pr(5, 4), -1, false},
    {Fact::kWarningMask, pr(6, 38), -1, false},   {Fact::kPositiveLimit, pr(7, 11), -1, false},
    {Fact::kNegativeLimit, pr(7, 12), -1, false}, {Fact::kCycle, pr(7, 20), -1, false},
    {Fact::kRatio, pr(7, 21), -1, false},         {Fact::kWideBlocks, pr(7, 22), 0, true},
    {Fact::kFullSync, pr(7, 22), 1, true},        {Fact::kScaleMonitor, pr(7, 22), 4, true},
    {Fact::kWriteInhibited, pr(7, 23), 0, false}, {Fact::kAlarmSubNumber, pr(7, 23), 1, true},
    {Fact::kInhibitSilent, pr(7, 23), 2, true},   {Fact::kInhibitSwapped, pr(7, 23), 3, true},
    {Fact::kExtendMode, pr(7, 23), 5, true},      {Fact::kInhibitInverted, pr(7, 23), 6, true},
    {Fact::kLimitsSwapped, pr(7, 23), 7, true},   {Fact::kAcOff, pr(7, 23), 8, true},
    {Fact::kSpeedUnit, pr(7, 25), -1, true},      {Fact::kCounterWarning, pr(7, 28), -1, false},
    {Fact::kMonitor1, pr(7, 29), -1, true},       {Fact::kMonitor2, pr(7, 30), -1, true},
    {Fact::kMonitor3, pr(7, 31), -1, true},       {Fact::kMonitor4, pr(7, 32), -1, true},
    {Fact::kMonitor5, pr(7, 33), -1, true},       {Fact::kMonitor6, pr(7, 34), -1, true},
    {Fact::kForward1, pr(7, 35), -1, true},       {Fact::kForward2, pr(7, 36), -1, true},
    {Fact::kForward3, pr(7, 37), -1, true},       {Fact::kCounterError, pr(7, 38), -1, false},
};
static_assert([] {
  if (std::size(kFacts) != kFactCount) return false;
  for (std::size_t i = 0; i < kFactCount; ++i) {
    if (kFacts[i].fact != static_cast<Fact>(i)) return false;
  }
  return true;
}());

struct Known {
  std::int32_t value = 0;
  Basis basis;  // kNone: not known at all

  explicit operator bool() const { return basis.kind != BasisKind::kNone; }
  bool certain() const { return basis.kind == BasisKind::kConfigured || basis.kind == BasisKind::kCapture; }
  bool is(std::int32_t wanted) const { return basis.kind != BasisKind::kNone && value == wanted; }
  bool certainly(std::int32_t wanted) const { return certain() && value == wanted; }
};

struct ParameterAttribute {
  std::uint16_t index = 0;
  Attribute attribute = Attribute::kUnknown;
};

class Knowledge {
 public:
  Knowledge();

  const Known& operator[](Fact fact) const { return known_[static_cast<std::size_t>(fact)]; }
  // Settings win over everything the capture shows.
  void configure(const RtexAxisSettings& axis);
  // The value of a parameter as a completed read shows it. Of no weight while an earlier write of it waits.
  void on_read(std::uint16_t index, std::int32_t value, std::uint64_t frame);
  // A completed write.
  void on_write(std::uint16_t index, std::int32_t value, Attribute attribute, std::uint64_t frame);
  void on_eeprom_write();
  void on_validation();  // a completed attribute C validation
  void on_reset();       // a software reset
  void on_lost();        // what happened meanwhile is not known: lost records, a new start of the ring
  // The attribute as a read of it (040h) showed it, else as the manual prints it.
  void on_attribute(std::uint16_t index, Attribute attribute);
  Attribute attribute(std::uint16_t index) const;
  // Something the drive did proves the value.
  void prove(Fact fact, std::int32_t value, std::uint64_t frame);

  BlockFormat format() const;

  // A written parameter that a validation or a reset may still be needed for.
  struct Waiting {
    std::uint16_t index = 0;
    std::int32_t value = 0;
    Attribute attribute = Attribute::kUnknown;
    std::uint64_t frame = 0;
    bool in_eeprom = false;
    bool lost = false;  // a reset may have come in records that were lost
  };
  std::span<const Waiting> waiting() const { return std::span(waiting_).first(waiting_count_); }
  // True where a write of the parameter is not known to act yet.
  bool is_pending(std::uint16_t index) const;
  // The writes since the last EEPROM write: a reset loses them.
  struct Unsaved {
    std::uint32_t count = 0;
    std::uint16_t index = 0;  // of the first
    std::uint64_t frame = 0;
  };
  const Unsaved& unsaved() const { return unsaved_; }

 private:
  static constexpr std::size_t kMaxWaiting = 32;
  static constexpr std::size_t kMaxAttributes = 64;

  void learn(std::uint16_t index, std::int32_t value, std::uint64_t frame);
  void forget(std::uint16_t index);

  std::array<Known, kFactCount> known_ = {};
  std::array<Waiting, kMaxWaiting> waiting_ = {};
  std::size_t waiting_count_ = 0;
  Unsaved unsaved_;
  SmallVector<ParameterAttribute, kMaxAttributes> attributes_;
};

}  // namespace servotrace::rtex
