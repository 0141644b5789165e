// SPDX-License-Identifier: MIT
// Classic pcap: both byte orders, micro- and nanoseconds, and the 24-byte record headers of old patched libpcaps.
#include <array>

#include "replay/capture/limits.hpp"
#include "replay/capture/readers.hpp"
#include "replay/capture/wire.hpp"

namespace servotrace::replay {
namespace {

constexpr std::size_t kFileHeader = 24;  // bytes
constexpr std::uint32_t kMicroseconds = 0xA1B2C3D4;
constexpr std::uint32_t kNanoseconds = 0xA1B23C4D;
constexpr std::uint32_t kPatched = 0xA1B2CD34;        // 8 more bytes in each record header
constexpr std::uint32_t kLinkTypeMask = 0x03FF'FFFF;  // above: length of the frame check sequence

// Version 2.3 files, and those of one vendor (major 543), have the two lengths of a record in either order.
enum class Lengths : std::uint8_t { kCapturedFirst, kCapturedLast, kSmallerIsCaptured };

class PcapSource final : public FileSource {
 public:
  PcapSource(std::unique_ptr<Input> input, std::string name, std::string format)
      : FileSource(std::move(input), std::move(name), std::move(format)) {}

  Result<void> read_header() {
    const Bytes header = input_->peek(kFileHeader);
    if (header.size() < kFileHeader) {
      if (input_->failure()) return broken(header.size(), *input_->failure());
      return broken(0, "the file ends inside its header (" + std::to_string(header.size()) + " of " +
                           std::to_string(kFileHeader) + " bytes)");
    }
    const std::uint8_t* const at = header.data();
    std::uint32_t magic = load32(at, false);
    swap_ = magic != kMicroseconds && magic != kNanoseconds && magic != kPatched;
    magic = load32(at, swap_);
    nanoseconds_ = magic == kNanoseconds;
    record_header_ = magic == kPatched ? 24 : 16;
    const std::uint16_t major = load16(at + 4, swap_);
    const std::uint16_t minor = load16(at + 6, swap_);
    if (major != 2 && major != 543)
      return broken(4, "pcap version " + std::to_string(major) + "." + std::to_string(minor) + " is not known");
    if (major == 543 || minor == 3) lengths_ = Lengths::kSmallerIsCaptured;
    if (major == 2 && minor < 3) lengths_ = Lengths::kCapturedLast;
    const std::uint32_t link = load32(at + 20, swap_) & kLinkTypeMask;
    link_type_ = static_cast<LinkType>(link > 0xFFFF ? 0xFFFFU : link);
    interfaces_.push_back({.link_type = link_type_, .name = {}, .time_resolution_ns = nanoseconds_ ? 1U : 1000U});
    input_->skip(kFileHeader);
    return {};
  }

  Step next(RawFrame& frame) override {
    const Bytes header = input_->peek(record_header_);
    if (header.size() < record_header_) return end(header.size(), record_header_);
    std::uint32_t captured = load32(header.data() + 8, swap_);
    std::uint32_t original = load32(header.data() + 12, swap_);
    if (lengths_ == Lengths::kCapturedLast || (lengths_ == Lengths::kSmallerIsCaptured && captured > original))
      std::swap(captured, original);
    if (captured > kMaxPacket) {
      return fail(input_->position(), "a record of " + std::to_string(captured) + " bytes, more than the " +
                                          std::to_string(kMaxPacket) + " a capture can hold: the file is damaged here");
    }
    const std::size_t whole = record_header_ + captured;
    const Bytes record = input_->peek(whole);
    if (record.size() < whole) return end(record.size(), whole);
    if (!intact(record)) return fail_lost();
    frame.number = ++number_;
    const std::uint32_t second = load32(record.data(), swap_);
    const std::uint32_t fraction = load32(record.data() + 4, swap_);
    frame.time_ns = TimeNs{second} * kSecondNs + (nanoseconds_ ? TimeNs{fraction} : TimeNs{fraction} * kMicrosecondNs);
    frame.link_type = link_type_;
    frame.interface_id = 0;
    frame.bytes = record.subspan(record_header_);
    frame.original_length = original;
    frame.file_order = order_of(swap_);
    frame.time_resolution_ns = nanoseconds_ ? 1U : 1000U;
    frame.has_time = true;
    byte_offset_ = input_->position() + record_header_;
    input_->skip(whole);
    return Step::kFrame;
  }

 private:
  std::uint64_t number_ = 0;
  std::size_t record_header_ = 16;  // bytes
  LinkType link_type_ = LinkType::kEthernet;
  Lengths lengths_ = Lengths::kCapturedFirst;
  bool swap_ = false;
  bool nanoseconds_ = false;
};

}  // namespace

Result<std::unique_ptr<Source>> read_pcap(std::unique_ptr<Input> input, std::string name, std::string format) {
  auto source = std::make_unique<PcapSource>(std::move(input), std::move(name), std::move(format));
  const Result<void> header = source->read_header();
  if (!header) return header.error();
  return std::unique_ptr<Source>(std::move(source));
}

}  // namespace servotrace::replay
