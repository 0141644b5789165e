// SPDX-License-Identifier: MIT
// Writes RTEX records (servotrace RTEX capture format 1) in one of their carriers.
#pragma once

#include <cstdint>
#include <vector>

#include "decoder/link/rtex_record.hpp"

namespace servotrace::simulator::ring {

struct RecordHeader {
  bool response = false;
  bool sequence_valid = true;
  bool cycle_valid = true;
  bool sampled = false;
  std::uint8_t ring = 0;
  std::uint32_t sequence = 0;
  std::uint32_t cycle_ns = 0;
  std::uint32_t wide_nodes = 0;
  std::uint8_t node_count = 0;
};

std::vector<std::uint8_t> make_record(const RecordHeader& header, Bytes blocks);
// The frame that carries `record`. kUserLink: the record itself.
std::vector<std::uint8_t> wrap_record(servotrace::rtex::Carrier carrier, Bytes record);
LinkType link_type_of(servotrace::rtex::Carrier carrier);

}  // namespace servotrace::simulator::ring
