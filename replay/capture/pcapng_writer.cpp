// SPDX-License-Identifier: MIT
#include "replay/capture/pcapng_writer.hpp"

#include <array>
#include <optional>
#include <vector>

#include "replay/capture/pcapng_format.hpp"
#include "replay/capture/whole_file.hpp"

namespace servotrace::replay {
namespace {

constexpr std::uint8_t kNanoseconds = 9;           // if_tsresol: 10^-9
constexpr std::uint32_t kNoSnapLength = 0;         // unlimited
constexpr std::size_t kMaxComment = 0xFFFF;        // bytes; the option's length field
constexpr std::uint32_t kMaxPacket = 0x7FFF'0000;  // bytes; keeps a block's length in its field

// A block being put together, little-endian.
class Block {
 public:
  void start(std::uint32_t type) {
    bytes_.clear();
    put(type, 4);
    put(0, 4);
  }
  void put(std::uint64_t value, unsigned byte_count) {
    for (unsigned i = 0; i < byte_count; ++i) bytes_.push_back(static_cast<std::uint8_t>(value >> (8U * i)));
  }
  void put_padded(Bytes bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    bytes_.resize(pcapng::padded(bytes_.size()));
  }
  void option(std::uint16_t code, Bytes bytes) {
    put(code, 2);
    put(bytes.size(), 2);
    put_padded(bytes);
  }
  void option(std::uint16_t code, std::string_view text) {
    option(code, Bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
  }
  Bytes finish() {
    const std::uint64_t total = bytes_.size() + 4;
    put(total, 4);
    for (unsigned i = 0; i < 4; ++i) bytes_[4 + i] = static_cast<std::uint8_t>(total >> (8U * i));
    return bytes_;
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

// Cut to `limit` bytes, never inside a UTF-8 character.
std::string_view cut(std::string_view text, std::size_t limit) {
  if (text.size() <= limit) return text;
  while (limit > 0 && (static_cast<unsigned char>(text[limit]) & 0xC0U) == 0x80U) --limit;
  return text.substr(0, limit);
}

}  // namespace

struct PcapngWriter::Impl {
  std::unique_ptr<WholeFile> file;
  std::string name;
  Block block;
  std::vector<std::uint32_t> resolutions;  // nanoseconds, by interface
  std::optional<Error> error;

  void fail(std::string what) {
    if (!error) error = Error{name, std::move(what)};
  }
};

PcapngWriter::PcapngWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
PcapngWriter::~PcapngWriter() = default;

Result<std::unique_ptr<PcapngWriter>> PcapngWriter::create(const std::filesystem::path& path) {
  auto file = WholeFile::create(path);
  if (!file) return file.error();
  auto impl = std::make_unique<Impl>();
  impl->file = std::move(file.value());
  impl->name = path.string();
  Block& block = impl->block;
  block.start(pcapng::kSectionHeader);
  block.put(pcapng::kByteOrderMagic, 4);
  block.put(1, 2);  // version 1.0
  block.put(0, 2);
  block.put(0xFFFF'FFFF'FFFF'FFFF, 8);  // the section's length is not given
  block.option(pcapng::kSectionApplication, std::string_view("servotrace"));
  block.put(0, 4);
  impl->file->write(block.finish());
  return std::unique_ptr<PcapngWriter>(new PcapngWriter(std::move(impl)));
}

std::uint32_t PcapngWriter::add_interface(LinkType link_type, std::string_view name, std::uint32_t resolution_ns) {
  std::uint8_t places = kNanoseconds;
  std::uint32_t tick_ns = 1;
  while (places > 1 && tick_ns < resolution_ns) {
    tick_ns *= 10;
    --places;
  }
  if (tick_ns != resolution_ns) {
    tick_ns = 1;
    places = kNanoseconds;
  }
  Block& block = impl_->block;
  block.start(pcapng::kInterfaceDescription);
  block.put(static_cast<std::uint16_t>(link_type), 2);
  block.put(0, 2);
  block.put(kNoSnapLength, 4);
  if (!name.empty()) block.option(pcapng::kInterfaceName, cut(name, kMaxComment));
  block.option(pcapng::kTimeResolution, Bytes(&places, 1));
  block.put(0, 4);
  impl_->file->write(block.finish());
  impl_->resolutions.push_back(tick_ns);
  return static_cast<std::uint32_t>(impl_->resolutions.size() - 1);
}

void PcapngWriter::write(std::uint32_t interface_id, TimeNs time_ns, Bytes bytes, std::uint32_t original_length,
                         std::string_view comment) {
  Impl& self = *impl_;
  if (interface_id >= self.resolutions.size()) return self.fail("a frame of an interface that was not described");
  if (time_ns < 0) return self.fail("a time before 1970 cannot be written");
  if (bytes.size() > kMaxPacket) return self.fail("a frame is too long to be written");
  Block& block = self.block;
  block.start(pcapng::kEnhancedPacket);
  block.put(interface_id, 4);
  const auto ticks = static_cast<std::uint64_t>(time_ns) / self.resolutions[interface_id];
  block.put(ticks >> 32U, 4);
  block.put(ticks & 0xFFFF'FFFFU, 4);
  block.put(bytes.size(), 4);
  block.put(original_length, 4);
  block.put_padded(bytes);
  if (!comment.empty()) {
    block.option(pcapng::kComment, cut(comment, kMaxComment));
    block.put(0, 4);
  }
  self.file->write(block.finish());
}

Result<void> PcapngWriter::finish() {
  if (impl_->error) return *impl_->error;
  return impl_->file->finish();
}

}  // namespace servotrace::replay
