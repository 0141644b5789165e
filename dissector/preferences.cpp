// SPDX-License-Identifier: GPL-2.0-or-later
#include "dissector/preferences.hpp"

#include "dissector/entries.hpp"
#include "dissector/fields.hpp"
#include "dissector/tables.hpp"
#include "dissector/ws.hpp"

namespace servotrace::plugin {
namespace {

constexpr unsigned kEthertype = 0x88B5;
constexpr unsigned kUdpPort = 35224;
constexpr unsigned kFirstUserLink = 147;
constexpr unsigned kLastUserLink = 162;

// Wireshark writes into these.
struct Chosen {
  guint ethertype = kEthertype;
  guint udp_port = kUdpPort;
  guint user_link_type = 0;
  WsBool can_is_devicenet = false;
  const char* settings_file = "";
};
Chosen& chosen() {
  static Chosen instance;
  return instance;
}

bool read_file(const char* file, replay::FileSettings& settings) {
  Result<replay::FileSettings> read = replay::read_settings(file);
  if (read) {
    settings = std::move(read.value());
    return true;
  }
  report_failure("servotrace: %s", read.error().text().c_str());
  return false;
}

}  // namespace

void register_preferences() {
  Chosen& values = chosen();
  module_t* const rtex = prefs_register_protocol(protocol_id("rtex"), apply_carriers);
  prefs_register_uint_preference(rtex, "ethertype", "EtherType", "EtherType of mirrored RTEX records (0: none)", 16,
                                 &values.ethertype);
  prefs_register_uint_preference(rtex, "udp_port", "UDP port", "UDP port of mirrored RTEX records (0: none)", 10,
                                 &values.udp_port);
  prefs_register_uint_preference(rtex, "user_link_type", "User link type",
                                 "Link type of captures that hold bare RTEX records, 147 to 162 (USER0 to USER15); "
                                 "0: none. It takes that link type away from DLT_USER.",
                                 10, &values.user_link_type);
  module_t* const dnet = prefs_register_protocol(protocol_id("dnet"), nullptr);
  prefs_register_bool_preference(dnet, "can_is_devicenet", "CAN is DeviceNet",
                                 "Take 11-bit CAN frames as DeviceNet without waiting for evidence in the traffic",
                                 &values.can_is_devicenet);
  module_t* const servotrace = prefs_register_protocol(servotrace_protocol_id(), nullptr);
  prefs_register_filename_preference(servotrace, "settings_file", "Settings file (servotrace.toml)",
                                     "Names, profiles, parameters and limits, the same file the command line reads",
                                     &values.settings_file, FALSE);
  register_tables(servotrace);
}

Carriers current_carriers() {
  const Chosen& values = chosen();
  const bool user = values.user_link_type >= kFirstUserLink && values.user_link_type <= kLastUserLink;
  return {static_cast<std::uint16_t>(values.ethertype <= 0xFFFF ? values.ethertype : 0),
          static_cast<std::uint16_t>(values.udp_port <= 0xFFFF ? values.udp_port : 0),
          static_cast<std::uint16_t>(user ? values.user_link_type : 0)};
}

replay::FileSettings current_settings() {
  replay::FileSettings settings;
  const Carriers carriers = current_carriers();
  const char* const file = chosen().settings_file;
  const bool has_file = file != nullptr && *file != '\0' && read_file(file, settings);
  Settings& decoder = settings.decoder;
  if (!has_file || carriers.ethertype != kEthertype) decoder.rtex.ethertype = carriers.ethertype;
  if (!has_file || carriers.udp_port != kUdpPort) decoder.rtex.udp_port = carriers.udp_port;
  if (!has_file || carriers.user_link_type != 0) decoder.rtex.user_link_type = carriers.user_link_type;
  apply_tables(decoder);
  if (chosen().can_is_devicenet || can_is_decoded_as_devicenet()) decoder.devicenet.assumed = true;
  return settings;
}

}  // namespace servotrace::plugin
