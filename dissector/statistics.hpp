// SPDX-License-Identifier: GPL-2.0-or-later
// Statistics: windows under Wireshark's Statistics menu, and `tshark -q -z NAME,tree`.
//   servotrace_findings   findings by severity, rule and node
//   rtex_ring             records, cycle times and their jitter, communication errors and missed updates an axis
//   rtex_handshake        latencies of non-cyclic commands, by command
//   dnet_nodes            messages, response times and errors of each node
#pragma once

#include "dissector/session.hpp"
#include "dissector/ws.hpp"

namespace servotrace::plugin {

void register_statistics();

// Hands the frame to whatever statistics are open.
void count_frame(packet_info* pinfo, const Visit& frame);

}  // namespace servotrace::plugin
