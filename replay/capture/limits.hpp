// SPDX-License-Identifier: MIT
// What a capture file may ask for. Beyond these it is refused as broken: memory stays bounded whatever the bytes say.
#pragma once

#include <cstddef>
#include <cstdint>

namespace servotrace::replay {

inline constexpr std::size_t kMaxBlock = 16U * 1024 * 1024;  // bytes of a pcapng block, as in Wireshark
inline constexpr std::size_t kMaxPacket = 262'144;           // bytes of a pcap record, as in libpcap and Wireshark
inline constexpr std::size_t kMaxLine = 64U * 1024;          // bytes of a line of a text log
inline constexpr std::size_t kMaxInterfaces = 65'536;        // over all sections
inline constexpr std::size_t kMaxName = 128;                 // bytes of an interface name; longer ones are cut
inline constexpr std::size_t kMaxDropReports = 65'536;       // kept until the caller takes them
inline constexpr std::size_t kChunk = 256U * 1024;           // bytes read at once from a stream

}  // namespace servotrace::replay
