// SPDX-License-Identifier: MIT
// Numbers of the pcapng file format (IETF draft-ietf-opsawg-pcapng), for its reader and its writer.
#pragma once

#include <cstddef>
#include <cstdint>

namespace servotrace::replay::pcapng {

// Block types.
inline constexpr std::uint32_t kSectionHeader = 0x0A0D0D0A;  // reads the same in both byte orders
inline constexpr std::uint32_t kInterfaceDescription = 1;
inline constexpr std::uint32_t kObsoletePacket = 2;
inline constexpr std::uint32_t kSimplePacket = 3;
inline constexpr std::uint32_t kInterfaceStatistics = 5;
inline constexpr std::uint32_t kEnhancedPacket = 6;

inline constexpr std::uint32_t kJournal = 9;
inline constexpr std::uint32_t kSysdigEvent = 0x204;
inline constexpr std::uint32_t kSysdigEvent2 = 0x216;
inline constexpr std::uint32_t kSysdigLargeEvent2 = 0x221;
inline constexpr std::uint32_t kCustom = 0xBAD;
inline constexpr std::uint32_t kCustomNoCopy = 0x40000BAD;
inline constexpr std::uint32_t kNetflix = 10949;  // the one enterprise whose custom blocks Wireshark does not number

inline constexpr std::uint32_t kByteOrderMagic = 0x1A2B3C4D;

// Option codes.
inline constexpr std::uint16_t kEndOfOptions = 0;
inline constexpr std::uint16_t kComment = 1;
inline constexpr std::uint16_t kSectionApplication = 4;  // shb_userappl
inline constexpr std::uint16_t kInterfaceName = 2;       // if_name
inline constexpr std::uint16_t kTimeResolution = 9;      // if_tsresol
inline constexpr std::uint16_t kTimeOffset = 14;         // if_tsoffset, seconds
inline constexpr std::uint16_t kPacketDropCount = 4;     // epb_dropcount
inline constexpr std::uint16_t kInterfaceDrops = 5;      // isb_ifdrop
inline constexpr std::uint16_t kSystemDrops = 7;         // isb_osdrop

inline constexpr std::size_t kBlockFrame = 12;  // type, total length, total length again

constexpr std::size_t padded(std::size_t size) { return (size + 3U) & ~std::size_t{3}; }

}  // namespace servotrace::replay::pcapng
