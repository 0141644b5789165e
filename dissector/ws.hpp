// SPDX-License-Identifier: GPL-2.0-or-later
// The only header that includes Wireshark, and the only place that knows its versions (4.0, 4.2, 4.4, 4.6).
#pragma once

#include <cstdint>
#include <cstring>

#include <epan/column-utils.h>
#include <epan/epan.h>
#include <epan/expert.h>
#include <epan/packet.h>
#include <epan/prefs.h>
#include <epan/proto_data.h>
#include <epan/stats_tree.h>
#include <epan/tap.h>
#include <epan/tfs.h>
#include <epan/uat.h>
#include <wiretap/pcap-encap.h>
#include <wiretap/wtap.h>
#include <ws_version.h>
#include <wsutil/report_message.h>

#if !defined(WIRESHARK_VERSION_MAJOR) || !defined(WIRESHARK_VERSION_MINOR)
#error "ws_version.h names no Wireshark version"
#endif
#define SERVOTRACE_WS_AT_LEAST(major, minor) \
  (WIRESHARK_VERSION_MAJOR > (major) || (WIRESHARK_VERSION_MAJOR == (major) && WIRESHARK_VERSION_MINOR >= (minor)))

namespace servotrace::plugin {

// What heuristic dissectors and UAT checks return and boolean preferences are kept in.
#if SERVOTRACE_WS_AT_LEAST(4, 4)
using WsBool = bool;
#else
using WsBool = gboolean;
#endif

// False where the tree is built for a filter or a statistic only: texts need not be made.
inline bool is_visible(proto_tree* tree) { return tree != nullptr && PTREE_DATA(tree)->visible; }

// The name of a capture interface; nullptr where it has none.
inline const char* interface_name(const packet_info* pinfo, std::uint32_t interface_id, std::uint32_t section) {
#if SERVOTRACE_WS_AT_LEAST(4, 2)
  const char* const name = epan_get_interface_name(pinfo->epan, interface_id, section);
#else
  static_cast<void>(section);
  const char* const name = epan_get_interface_name(pinfo->epan, interface_id);
#endif
  return name == nullptr || std::strcmp(name, "unknown") == 0 ? nullptr : name;
}

}  // namespace servotrace::plugin
