// SPDX-License-Identifier: MIT
// The words of the NK rules' arguments.
#pragma once

#include "decoder/profiles/nsk_esb/alarms.hpp"
#include "decoder/profiles/nsk_esb/numbers.hpp"
#include "decoder/profiles/phase.hpp"

namespace servotrace::esb {

inline constexpr ValueName kDirectionWords[] = {{0, "read"}, {1, "written"}};
inline constexpr ValueName kAskedWords[] = {{0, "read"}, {1, "write"}};
inline constexpr ValueName kStartKindNames[] = {
    {0, "RUN rises"}, {1, "HOS rises"}, {2, "JOG rises"}, {3, "a motion command is requested"}};
inline constexpr ValueName kStopSources[] = {{0, "EMST"}, {1, "EMSTA"}};
inline constexpr ValueName kNotReadySources[] = {{0, "SVON"}, {1, "DRDY"}};
inline constexpr ValueName kProgramSessionNames[] = {{0, "edit (500)"}, {1, "read-out (501)"}};
inline constexpr ValueName kOpenUntilNames[] = {{0, "at a motion start"}, {1, "at the end of the capture"}};
inline constexpr ValueName kOverTravelNames[] = {{0, "OTPA (+)"}, {1, "OTMA (-)"}};
inline constexpr ValueName kHomeLostNames[] = {{0, "a home return was interrupted, or DI written outside the capture"},
                                               {1, "DI (101) was written"}};
// Patterns of the outputs, as alarms.hpp makes them.
inline constexpr ValueName kPatternNames[] = {{0, "DRDY 0, OVER 0, BRK 0"}, {1, "DRDY 1, OVER 0, BRK 0"},
                                              {2, "DRDY 0, OVER 1, BRK 0"}, {3, "DRDY 1, OVER 1, BRK 0"},
                                              {4, "DRDY 0, OVER 0, BRK 1"}, {5, "DRDY 1, OVER 0, BRK 1"},
                                              {6, "DRDY 0, OVER 1, BRK 1"}, {7, "DRDY 1, OVER 1, BRK 1"}};
inline constexpr ValueName kWordNames[] = {{-1, "not read"}};

namespace detail {
// Mnemonics of program commands, and 0 for none.
consteval auto command_names() {
  std::array<ValueName, kNumberNames.size()> names{};
  names[0] = {0, "no program command"};
  for (std::size_t i = 1; i < names.size(); ++i) names[i] = kNumberNames[i];
  return names;
}
}  // namespace detail
inline constexpr auto kCommandNames = detail::command_names();

}  // namespace servotrace::esb
