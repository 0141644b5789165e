// SPDX-License-Identifier: MIT
// pcapng (IETF draft-ietf-opsawg-pcapng): several sections, interfaces of different link types, all packet blocks.
#include <vector>

#include "replay/capture/limits.hpp"
#include "replay/capture/pcapng_format.hpp"
#include "replay/capture/readers.hpp"
#include "replay/capture/ticks.hpp"
#include "replay/capture/wire.hpp"

namespace servotrace::replay {
namespace {

using namespace pcapng;

constexpr std::size_t kSectionBody = 16;     // bytes before the options: magic, version, section length
constexpr std::size_t kInterfaceBody = 8;    // link type, reserved, snap length
constexpr std::size_t kPacketBody = 20;      // both kinds of packet block: interface, time, lengths
constexpr std::size_t kStatisticsBody = 12;  // interface, time

struct Interface {
  Ticks ticks;
  LinkType link_type = LinkType::kEthernet;
  std::uint32_t resolution_ns = 1000;
  std::uint32_t snap_length = 0;  // bytes, 0: unlimited
  std::uint64_t dropped = 0;      // reported so far
};

// Walks options: next() is true while there is one.
class Options {
 public:
  Options(Bytes bytes, bool swap) : bytes_(bytes), swap_(swap) {}
  bool next() {
    if (bytes_.size() < 4) {
      broken_ = !bytes_.empty();
      return false;
    }
    code = load16(bytes_.data(), swap_);
    const std::size_t length = load16(bytes_.data() + 2, swap_);
    if (code == kEndOfOptions) return false;
    if (4 + length > bytes_.size()) {
      broken_ = true;
      return false;
    }
    value = bytes_.subspan(4, length);
    bytes_ = bytes_.subspan(std::min(bytes_.size(), 4 + padded(length)));
    return true;
  }
  // An option says that it is longer than its block.
  bool broken() const { return broken_; }

  std::uint16_t code = 0;
  Bytes value;

 private:
  Bytes bytes_;
  bool swap_;
  bool broken_ = false;
};

class PcapngSource final : public FileSource {
 public:
  PcapngSource(std::unique_ptr<Input> input, std::string name, std::string format)
      : FileSource(std::move(input), std::move(name), std::move(format)) {}

  // The first section header, so that a broken file is refused when it is opened.
  Result<void> open() {
    Bytes block;
    if (next_block(block) != Step::kFrame) {
      if (truncation_)
        return broken(0, "the file ends inside its first block (" + std::to_string(truncation_->captured) + " of " +
                             std::to_string(truncation_->expected) + " bytes)");
      return error_;
    }
    if (!start_section(block)) return error_;
    return {};
  }

  Step next(RawFrame& frame) override {
    if (plain_packet(frame)) [[likely]]
      return Step::kFrame;
    for (;;) {
      Bytes block;
      const Step step = next_block(block);
      if (step != Step::kFrame) return step;
      switch (load32(block.data(), swap_)) {
        case kEnhancedPacket:
          return enhanced_packet(block, frame);
        case kSimplePacket:
          return simple_packet(block, frame);
        case kObsoletePacket:
          return obsolete_packet(block, frame);
        case kSectionHeader:
          if (!start_section(block)) return Step::kError;
          break;
        case kInterfaceDescription:
          if (!add_interface(block)) return Step::kError;
          break;
        case kInterfaceStatistics:
          if (!statistics(block)) return Step::kError;
          break;
        default:
          if (is_numbered(block)) ++number_;
          break;  // name resolution, secrets, custom blocks: nothing of a bus
      }
    }
  }

 private:
  // The block that nearly every one is: a small enhanced packet in this machine's byte order, without options, whole,
  // and at hand. False, and nothing was taken, for any other and for whatever is wrong.
  bool plain_packet(RawFrame& frame) {
    constexpr std::size_t kFrame = kBlockFrame + kPacketBody;
    constexpr std::size_t kSmall = 4096;  // touches no page but those of its head and its tail
    const Bytes there = input_->at_hand();
    if (swap_ || there.size() < kFrame) return false;
    const std::uint8_t* const at = there.data();
    const std::size_t total = load32(at + 4, false);
    const std::uint32_t id = load32(at + 8, false);
    const std::size_t captured = load32(at + 20, false);
    if (load32(at, false) != kEnhancedPacket || total > there.size() || total > kSmall || captured > kSmall ||
        total != kFrame + padded(captured) || load32(at + total - 4, false) != total || id >= section_.size() ||
        input_->lost()) {
      return false;
    }
    const Interface& interface = section_[id];
    frame.number = ++number_;
    frame.time_ns = interface.ticks.to_ns(std::uint64_t{load32(at + 12, false)} << 32U | load32(at + 16, false));
    frame.link_type = interface.link_type;
    frame.interface_id = static_cast<std::uint32_t>(section_base_) + id;
    frame.bytes = there.subspan(28, captured);
    frame.original_length = load32(at + 24, false);
    frame.file_order = order_of(false);
    frame.time_resolution_ns = interface.resolution_ns;
    frame.has_time = true;
    block_at_ = input_->position();
    byte_offset_ = block_at_ + 28;
    input_->skip(total);
    return true;
  }

  // Takes the next block from the input. kFrame: `block` holds it, head and tail included.
  Step next_block(Bytes& block) {
    const Bytes head = input_->peek(8);
    if (head.size() < 8) return end(head.size(), 8);
    bool swap = swap_;
    if (load32(head.data(), false) == kSectionHeader) {
      const Bytes section = input_->peek(12);
      if (section.size() < 12) return end(section.size(), 12);
      swap = load32(section.data() + 8, false) != kByteOrderMagic;
      if (load32(section.data() + 8, swap) != kByteOrderMagic)
        return fail(input_->position() + 8, "a pcapng section without its byte-order magic: the file is damaged here");
    }
    const std::size_t total = load32(input_->peek(8).data() + 4, swap);
    if (total < kBlockFrame || total % 4 != 0 || total > kMaxBlock) {
      return fail(input_->position() + 4, "a pcapng block of " + std::to_string(total) +
                                              " bytes, which is no possible length: the file is damaged here");
    }
    block = input_->peek(total);
    if (block.size() < total) return end(block.size(), total);
    if (!intact(block)) return fail_lost();
    const std::size_t again = load32(block.data() + total - 4, swap);
    if (again != total) {
      return fail(input_->position() + total - 4, "a pcapng block of " + std::to_string(total) +
                                                      " bytes ends with the length " + std::to_string(again) +
                                                      ": the file is damaged here");
    }
    swap_ = swap;
    block_at_ = input_->position();
    input_->skip(total);
    return Step::kFrame;
  }

  // Wireshark 4 gives these blocks, which are no packets, a frame number too.
  bool is_numbered(Bytes block) const {
    switch (load32(block.data(), swap_)) {
      case kJournal:
      case kSysdigEvent:
      case kSysdigEvent2:
      case kSysdigLargeEvent2:
        return true;
      case kCustom:
      case kCustomNoCopy:
        return block.size() > kBlockFrame && load32(block.data() + 8, swap_) != kNetflix;
      default:
        return false;
    }
  }

  bool refuse(std::string what) {
    fail(block_at_, std::move(what));
    return false;
  }

  bool start_section(Bytes block) {
    if (block.size() < kBlockFrame + kSectionBody) return refuse("a pcapng section header that is too short");
    const std::uint16_t major = load16(block.data() + 12, swap_);
    if (major != 1) return refuse("pcapng version " + std::to_string(major) + " is not known");
    section_base_ = interfaces_.size();
    section_.clear();
    return true;
  }

  bool add_interface(Bytes block) {
    if (block.size() < kBlockFrame + kInterfaceBody) return refuse("a pcapng interface description that is too short");
    if (interfaces_.size() >= kMaxInterfaces)
      return refuse("more than " + std::to_string(kMaxInterfaces) + " interfaces");
    Interface interface;
    InterfaceInfo info;
    interface.link_type = info.link_type = static_cast<LinkType>(load16(block.data() + 8, swap_));
    interface.snap_length = load32(block.data() + 12, swap_);
    Options options(block.subspan(16, block.size() - 20), swap_);
    while (options.next()) {
      if (options.code == kInterfaceName) {
        const std::size_t length = std::min(options.value.size(), kMaxName);
        info.name.assign(options.value.begin(), options.value.begin() + static_cast<std::ptrdiff_t>(length));
        info.name.resize(info.name.find('\0') == std::string::npos ? info.name.size() : info.name.find('\0'));
      } else if (options.code == kTimeResolution && options.value.size() == 1) {
        if (!interface.ticks.set(options.value[0]))
          return refuse("an interface with a time resolution (if_tsresol " + std::to_string(options.value[0]) +
                        ") that is not supported");
      } else if (options.code == kTimeOffset && options.value.size() == 8) {
        interface.ticks.set_offset_s(static_cast<std::int64_t>(load64(options.value.data(), swap_)));
      }
    }
    if (options.broken()) return refuse("an interface description with an option longer than its block");
    interface.resolution_ns = info.time_resolution_ns = interface.ticks.resolution_ns();
    section_.push_back(interface);
    interfaces_.push_back(std::move(info));
    return true;
  }

  Interface* interface_of(std::uint32_t id) {
    if (id < section_.size()) return &section_[id];
    fail(block_at_, "a record of interface " + std::to_string(id) + ", but its section describes only " +
                        std::to_string(section_.size()));
    return nullptr;
  }

  // What both packet blocks have in common. `data_at` is the offset of the packet in the block.
  Step packet(Bytes block, std::uint32_t id, std::uint64_t ticks, std::size_t data_at, std::uint32_t captured,
              std::uint32_t original, RawFrame& frame) {
    const Interface* const interface = interface_of(id);
    if (interface == nullptr) return Step::kError;
    const std::size_t room = block.size() - data_at - 4;
    if (captured > room) {
      return fail(block_at_, "a record of " + std::to_string(captured) + " bytes in a block that has room for " +
                                 std::to_string(room) + ": the file is damaged here");
    }
    frame.number = ++number_;
    frame.time_ns = interface->ticks.to_ns(ticks);
    frame.link_type = interface->link_type;
    frame.interface_id = static_cast<std::uint32_t>(section_base_) + id;
    frame.bytes = block.subspan(data_at, captured);
    frame.original_length = original;
    frame.file_order = order_of(swap_);
    frame.time_resolution_ns = interface->resolution_ns;
    frame.has_time = true;
    byte_offset_ = block_at_ + data_at;
    return Step::kFrame;
  }

  Step enhanced_packet(Bytes block, RawFrame& frame) {
    if (block.size() < kBlockFrame + kPacketBody) return too_short();
    const std::uint8_t* const at = block.data() + 8;
    const std::uint32_t id = load32(at, swap_);
    const std::uint64_t ticks = std::uint64_t{load32(at + 4, swap_)} << 32U | load32(at + 8, swap_);
    const std::uint32_t captured = load32(at + 12, swap_);
    const Step step = packet(block, id, ticks, 28, captured, load32(at + 16, swap_), frame);
    const std::size_t options_at = 28 + padded(captured);
    if (step == Step::kFrame && block.size() >= options_at + 8) [[unlikely]] {
      Options options(block.subspan(options_at, block.size() - options_at - 4), swap_);
      while (options.next()) {
        if (options.code == kPacketDropCount && options.value.size() == 8)
          add_drops(id, load64(options.value.data(), swap_), number_ - 1);
      }
    }
    return step;
  }

  Step obsolete_packet(Bytes block, RawFrame& frame) {
    if (block.size() < kBlockFrame + kPacketBody) return too_short();
    const std::uint8_t* const at = block.data() + 8;
    const std::uint32_t id = load16(at, swap_);
    const std::uint16_t drops = load16(at + 2, swap_);
    const std::uint64_t ticks = std::uint64_t{load32(at + 4, swap_)} << 32U | load32(at + 8, swap_);
    const Step step = packet(block, id, ticks, 28, load32(at + 12, swap_), load32(at + 16, swap_), frame);
    constexpr std::uint16_t kUnknown = 0xFFFF;
    if (step == Step::kFrame && drops != kUnknown) add_drops(id, drops, number_ - 1);
    return step;
  }

  Step simple_packet(Bytes block, RawFrame& frame) {
    if (block.size() < kBlockFrame + 4) return too_short();
    const Interface* const interface = interface_of(0);
    if (interface == nullptr) return Step::kError;
    const std::uint32_t original = load32(block.data() + 8, swap_);
    auto captured = static_cast<std::uint32_t>(std::min<std::size_t>(original, block.size() - kBlockFrame - 4));
    if (interface->snap_length != 0) captured = std::min(captured, interface->snap_length);
    const Step step = packet(block, 0, 0, 12, captured, original, frame);
    frame.time_ns = 0;
    frame.has_time = false;
    return step;
  }

  Step too_short() { return fail(block_at_, "a pcapng packet block that is too short: the file is damaged here"); }

  bool statistics(Bytes block) {
    if (block.size() < kBlockFrame + kStatisticsBody) return refuse("a pcapng statistics block that is too short");
    const std::uint32_t id = load32(block.data() + 8, swap_);
    Interface* const interface = interface_of(id);
    if (interface == nullptr) return false;
    std::uint64_t total = 0;  // since the interface was opened
    Options options(block.subspan(20, block.size() - 24), swap_);
    while (options.next()) {
      if ((options.code == kInterfaceDrops || options.code == kSystemDrops) && options.value.size() == 8)
        total += load64(options.value.data(), swap_);
    }
    if (total > interface->dropped) add_drops(id, total - interface->dropped, number_);
    return true;
  }

  void add_drops(std::uint32_t id, std::uint64_t count, std::uint64_t after_frame) {
    if (count == 0) return;
    section_[id].dropped += count;
    if (dropped_.size() < kMaxDropReports)
      dropped_.push_back({static_cast<std::uint32_t>(section_base_) + id, count, after_frame});
  }

  std::vector<Interface> section_;  // of the current section
  std::size_t section_base_ = 0;    // index of its first interface in interfaces_
  std::uint64_t number_ = 0;
  std::uint64_t block_at_ = 0;  // position of the block last taken
  bool swap_ = false;
};

}  // namespace

Result<std::unique_ptr<Source>> read_pcapng(std::unique_ptr<Input> input, std::string name, std::string format) {
  auto source = std::make_unique<PcapngSource>(std::move(input), std::move(name), std::move(format));
  const Result<void> opened = source->open();
  if (!opened) return opened.error();
  return std::unique_ptr<Source>(std::move(source));
}

}  // namespace servotrace::replay
