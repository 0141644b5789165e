// SPDX-License-Identifier: GPL-2.0-or-later
// Where Wireshark calls us.
#pragma once

namespace servotrace::plugin {

void register_entries();  // dissectors by name, the post-dissector, the start of a file
void hand_off_entries();  // their places in Wireshark's tables
void apply_carriers();    // the preferences changed

// The user chose "DeviceNet drives" for CAN under Decode As.
bool can_is_decoded_as_devicenet();

}  // namespace servotrace::plugin
