// SPDX-License-Identifier: GPL-2.0-or-later
// Draws a frame: columns, protocol tree, expert items. Wireshark's functions may leave by longjmp, which skips
// destructors: nothing that has one lives here, and text is made (text.hpp) before anything is drawn.
#pragma once

#include "dissector/session.hpp"
#include "dissector/ws.hpp"

namespace servotrace::plugin {

void draw(packet_info* pinfo, proto_tree* tree, const Visit& frame);

}  // namespace servotrace::plugin
