// SPDX-License-Identifier: GPL-2.0-or-later
// The symbols Wireshark looks for in a plugin. Each is declared extern with default visibility before it is defined: a
// namespace-scope const has internal linkage in C++, and Wireshark passes over a plugin whose symbols it cannot see.
#include "dissector/entries.hpp"
#include "dissector/fields.hpp"
#include "dissector/preferences.hpp"
#include "dissector/statistics.hpp"
#include "dissector/ws.hpp"

#define SERVOTRACE_EXPORT __attribute__((visibility("default"))) extern
#define SERVOTRACE_TEXT_OF(x) #x
#define SERVOTRACE_TEXT(x) SERVOTRACE_TEXT_OF(x)

extern "C" {
SERVOTRACE_EXPORT const char plugin_version[];
SERVOTRACE_EXPORT const int plugin_want_major;
SERVOTRACE_EXPORT const int plugin_want_minor;
SERVOTRACE_EXPORT void plugin_register();
SERVOTRACE_EXPORT std::uint32_t plugin_describe();

const char plugin_version[] = SERVOTRACE_TEXT(SERVOTRACE_VERSION);
const int plugin_want_major = WIRESHARK_VERSION_MAJOR;
const int plugin_want_minor = WIRESHARK_VERSION_MINOR;

static void register_protocols() {
  servotrace::plugin::register_fields();
  servotrace::plugin::register_preferences();
  servotrace::plugin::register_entries();
  servotrace::plugin::register_statistics();
}

static void hand_off() { servotrace::plugin::hand_off_entries(); }

void plugin_register() {
  static proto_plugin plugin;
  plugin.register_protoinfo = register_protocols;
  plugin.register_handoff = hand_off;
  proto_register_plugin(&plugin);
}

// Asked for by Wireshark 4.2 and later: 1, the plugin adds dissectors.
std::uint32_t plugin_describe() { return 1; }
}
