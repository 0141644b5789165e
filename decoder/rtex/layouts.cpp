// SPDX-License-Identifier: MIT
#include "decoder/rtex/layouts.hpp"

#include <vector>

#include "decoder/link/rtex_record.hpp"
#include "decoder/rtex/derived.hpp"

namespace servotrace::rtex {
namespace {

constexpr const Layout* kFixed[] = {&kCommand,
                                    &kResponse,
                                    &kResponseForms[0],
                                    &kResponseForms[1],
                                    &kResponseForms[2],
                                    &kResponseForms[3],
                                    &kRawData1,
                                    &kTargetPosition,
                                    &kCommandPosition,
                                    &kCommandSpeed,
                                    &kCommandSpeedUnits,
                                    &kCommandTorque,
                                    &kRawData2,
                                    &kReset,
                                    &kSystemId,
                                    &kHoming,
                                    &kAlarm,
                                    &kAlarmAttributeCommand,
                                    &kParameter,
                                    &kProfile,
                                    &kMonitor,
                                    &kRawData3,
                                    &kSettingData,
                                    &kTargetSpeed,
                                    &kTargetSpeedUnits,
                                    &kVelocityForward[0],
                                    &kVelocityForwardUnits[0],
                                    &kTorqueForward[0],
                                    &kRawResponse1,
                                    &kRawResponse2,
                                    &kRawResponse3,
                                    &kResetEcho,
                                    &kSystemIdEcho,
                                    &kHomingEcho,
                                    &kAlarmEcho,
                                    &kAlarmAttributeEcho,
                                    &kParameterEcho,
                                    &kProfileEcho,
                                    &kProfileEchoSwapped,
                                    &kMonitorEcho,
                                    &kError,
                                    &kZero3,
                                    &kCommunicationError,
                                    &kCharacters[0],
                                    &kRawMonitor[0],
                                    &kPositionEcho,
                                    &kAlarmCode,
                                    &kAlarmAttributeData,
                                    &kParameterValue,
                                    &kParameterCountData,
                                    &kParameterAttributeData,
                                    &kPr722,
                                    &kPr723,
                                    &kPr724,
                                    &kChoices[0],
                                    &kChoices[1],
                                    &kChoices[2],
                                    &kChoices[3],
                                    &kChoices[4],
                                    &kChoices[5],
                                    &kChoices[6],
                                    &kChoices[7],
                                    &kChoices[8],
                                    &kSubCommand,
                                    &kSubSystemId,
                                    &kSubMonitor,
                                    &kSubData1,
                                    &kSubData2,
                                    &kSubData3,
                                    &kVelocityForward[1],
                                    &kVelocityForwardUnits[1],
                                    &kTorqueForward[1],
                                    &kSubResponse,
                                    &kSubSystemIdEcho,
                                    &kSubMonitorEcho,
                                    &kSubError,
                                    &kSubZero1,
                                    &kSubRaw1,
                                    &kSubRaw2,
                                    &kSubRaw3,
                                    &kCharacters[1],
                                    &kRawMonitor[1]};

consteval bool all_well_formed() {
  for (const Layout* layout : kFixed) {
    if (!well_formed(*layout)) return false;
  }
  for (const auto& channel : kMonitorLayouts) {
    for (const auto& unit : channel) {
      for (const Layout& layout : unit) {
        if (!well_formed(layout)) return false;
      }
    }
  }
  for (const BitMapRow& row : kBitMaps) {
    if (!well_formed(row.layouts[0]) || !well_formed(row.layouts[1])) return false;
  }
  return true;
}
static_assert(all_well_formed());

constexpr std::size_t kSpeedMonitors = [] {
  std::size_t count = 0;
  for (const MonitorRow& row : kMonitors) count += row.speed;
  return count;
}();

constexpr std::size_t kAllCount = 1 + std::size(kFixed) + 2 * (kMonitorCount + kSpeedMonitors + std::size(kBitMaps));

// The monitors follow the fixed layouts, channel by channel; of those in command units a second only the speeds.
constexpr auto kAll = [] {
  std::array<const Layout*, kAllCount> all{};
  std::size_t next = 0;
  all[next++] = &kRecord;
  for (const Layout* layout : kFixed) all[next++] = layout;
  for (std::size_t channel = 0; channel < 2; ++channel) {
    for (std::size_t i = 0; i < kMonitorCount; ++i) {
      all[next++] = &kMonitorLayouts[channel][0][i];
      if (kMonitors[i].speed) all[next++] = &kMonitorLayouts[channel][1][i];
    }
    for (const BitMapRow& row : kBitMaps) all[next++] = &row.layouts[channel];
  }
  return all;
}();

constexpr auto kDerived = [] {
  std::array<const Field*, 5 + kSystemIdCount> all{&kEchoTimeField, &kCompletionTimeField, &kCycleTimeField,
                                                   &kDeviationField, &kHandshakeField};
  for (std::size_t i = 0; i < kSystemIdCount; ++i) all[5 + i] = &kSystemIds[i].field;
  return all;
}();

}  // namespace

std::span<const Layout* const> layouts() { return kAll; }
std::span<const Field* const> derived() { return kDerived; }

}  // namespace servotrace::rtex
