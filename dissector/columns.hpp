// SPDX-License-Identifier: GPL-2.0-or-later
// The columns of the packet list: protocol, ends, info.
#pragma once

#include "dissector/session.hpp"
#include "dissector/ws.hpp"

namespace servotrace::plugin {

// Nothing where no column is asked for.
void draw_columns(packet_info* pinfo, const Visit& frame);

// A new file: the texts made for the last one are forgotten.
void reset_columns();

}  // namespace servotrace::plugin
