// SPDX-License-Identifier: GPL-2.0-or-later
// Two tables a user may fill in Wireshark in the place of a servotrace.toml: axes and nodes.
#pragma once

#include "decoder/pipeline/settings.hpp"
#include "dissector/ws.hpp"

namespace servotrace::plugin {

void register_tables(module_t* module);

// Adds the entries of the tables; each replaces those of the same axis or node in `settings`.
void apply_tables(Settings& settings);

}  // namespace servotrace::plugin
