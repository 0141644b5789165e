// SPDX-License-Identifier: MIT
// CAN frames of one DeviceNet bus, typed by hand, and what `servotrace decode` prints of each.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "decoder/pipeline/pipeline.hpp"

namespace servotrace::test {

class CanDecoder {
 public:
  CanDecoder(std::uint8_t mac_id, std::string profile);

  // The text of this frame, 5 ms after the one before.
  std::string frame(std::uint32_t identifier, std::string_view hex_data);
  // A poll message of 10 bytes as its two fragments; the text of the second frame.
  std::string in_fragments(std::uint32_t identifier, std::string_view hex_data);

 private:
  Settings settings_;
  Pipeline pipeline_;
  std::uint64_t number_ = 0;
  TimeNs now_ns_ = 1'700'000'000 * kSecondNs;
};

}  // namespace servotrace::test
