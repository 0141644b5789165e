// SPDX-License-Identifier: GPL-2.0-or-later
// What the user chose in Wireshark: a servotrace.toml, the carriers of RTEX, whether CAN is DeviceNet.
#pragma once

#include "replay/settings/settings.hpp"

namespace servotrace::plugin {

void register_preferences();

// The settings a file is dissected with: of the servotrace.toml, and above it every preference that is not at its
// default. Read anew for each file, so that a reload takes a changed file. What is wrong with it is reported as
// Wireshark reports errors, and the preferences alone hold.
replay::FileSettings current_settings();

// The numbers RTEX is looked for at; user_link_type 0: nowhere.
struct Carriers {
  std::uint16_t ethertype = 0;
  std::uint16_t udp_port = 0;
  std::uint16_t user_link_type = 0;
};
Carriers current_carriers();

}  // namespace servotrace::plugin
