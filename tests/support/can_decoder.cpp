// SPDX-License-Identifier: MIT
#include "tests/support/can_decoder.hpp"

#include "decoder/render/dissection_text.hpp"
#include "tests/support/bytes.hpp"

namespace servotrace::test {
namespace {

Settings settings_for(std::uint8_t mac_id, std::string profile) {
  Settings settings;
  settings.devicenet.assumed = true;
  settings.devicenet.nodes.push_back({.mac_id = mac_id, .name = "", .profile = std::move(profile)});
  return settings;
}

}  // namespace

CanDecoder::CanDecoder(std::uint8_t mac_id, std::string profile)
    : settings_(settings_for(mac_id, std::move(profile))), pipeline_(settings_) {}

// A SocketCAN record: identifier (big-endian), length, three bytes, data.
std::string CanDecoder::frame(std::uint32_t identifier, std::string_view hex_data) {
  const std::vector<std::uint8_t> data = hex(hex_data);
  std::vector<std::uint8_t> record = {0,
                                      0,
                                      static_cast<std::uint8_t>(identifier >> 8U),
                                      static_cast<std::uint8_t>(identifier & 0xFFU),
                                      static_cast<std::uint8_t>(data.size()),
                                      0,
                                      0,
                                      0};
  record.insert(record.end(), data.begin(), data.end());
  now_ns_ += 5 * kMillisecondNs;
  Dissection dissection;
  pipeline_.push({.number = ++number_,
                  .time_ns = now_ns_,
                  .link_type = LinkType::kCanSocketcan,
                  .bytes = record,
                  .original_length = static_cast<std::uint32_t>(record.size())},
                 &dissection);
  std::string text;
  append_text(text, dissection, settings_, {});
  return text;
}

std::string CanDecoder::in_fragments(std::uint32_t identifier, std::string_view hex_data) {
  constexpr std::size_t kFirstPart = 7 * 3 - 1;  // characters of seven bytes
  frame(identifier, "00 " + std::string(hex_data.substr(0, kFirstPart)));
  return frame(identifier, "81" + std::string(hex_data.substr(kFirstPart)));
}

}  // namespace servotrace::test
