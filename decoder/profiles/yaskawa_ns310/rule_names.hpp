// SPDX-License-Identifier: MIT
// The words of the YS rules' arguments.
#pragma once

#include "decoder/core/layout.hpp"
#include "decoder/profiles/phase.hpp"
#include "decoder/profiles/yaskawa_ns310/alarms.hpp"

namespace servotrace::ns310 {

// The kind of operation that runs, as far as the capture shows it.
enum class Operation : std::uint8_t { kUnknown, kNone, kPositioning, kContinuous, kHoming, kBlock };
inline constexpr ValueName kOperationNames[] = {
    {0, "unknown"}, {1, "none"}, {2, "positioning"}, {3, "continuous rotation"}, {4, "homing"}, {5, "command blocks"},
};

inline constexpr ValueName kStartNames[] = {
    {0, "Start Trajectory"}, {1, "Start Block"}, {2, "Start Trajectory with Start Block"}};
inline constexpr ValueName kStopNames[] = {{0, "Smooth Stop"}, {1, "Hard Stop"}};
inline constexpr ValueName kReservedNames[] = {{0, "reserved bits of bytes 4-7 are set"},
                                               {1, "started with Alarm Clear (byte 4, bit 0) = 0"}};
inline constexpr ValueName kBothNames[] = {{0, ", which it does not start"},
                                           {1, ", together with Start Block: which counts is not defined"}};
inline constexpr ValueName kLimitNames[] = {{0, "CW hardware limit"},
                                            {1, "CCW hardware limit"},
                                            {2, "positive software limit"},
                                            {3, "negative software limit"}};
inline constexpr ValueName kSideNames[] = {{0, "negative"}, {1, "positive"}};
inline constexpr ValueName kBlockStartNames[] = {{0, "with block number 0"}, {1, "while blocks are in execution"}};
inline constexpr ValueName kRefusedCodes[] = {
    {kCodeNotRead, "unknown"},        {0x00, "NOP"},          {0x01, "Target position"},
    {0x02, "Target speed"},           {0x03, "Acceleration"}, {0x04, "Deceleration"},
    {0x11, "Continuous rotor speed"}, {0x12, "Homing type"},  {0x1E, "Alarm clear"}};
// Fault codes of object 26h, attribute 5 (B.8).
inline constexpr ValueName kBlockFaultNames[] = {{kCodeNotRead, "its code was not read (26h, attribute 5)"},
                                                 {0, "no fault"},
                                                 {1, "invalid or empty block data"},
                                                 {2, "command time-out"},
                                                 {3, "execution fault"}};

inline constexpr ValueName kEditStates[] = {{0, "while blocks are in execution"}, {1, "while an alarm is present"}};
inline constexpr ValueName kChainFaults[] = {{0, "is empty or undefined"},
                                             {1, "begins a loop that never ends and never waits"}};

}  // namespace servotrace::ns310
