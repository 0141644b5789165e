// SPDX-License-Identifier: MIT
#include "replay/capture/compressed.hpp"

#include <zlib.h>
#include <zstd.h>
#include <zstd_errors.h>

#include <algorithm>
#include <limits>

#include "replay/capture/limits.hpp"

namespace servotrace::replay {
namespace {

constexpr int kMaxWindowLog = 25;  // zstd: windows up to 32 MiB (levels up to 20); more would break our memory bound

// What both have in common: where the compressed bytes come from.
class Decompressed : public BufferedInput {
 public:
  explicit Decompressed(std::unique_ptr<Input> compressed) : compressed_(std::move(compressed)) {}
  std::uint64_t consumed() const override { return compressed_->consumed(); }
  std::uint64_t total() const override { return compressed_->total(); }

 protected:
  // Compressed bytes at hand; empty at their end.
  Bytes more() {
    const Bytes at_hand = compressed_->at_hand();
    const Bytes there = at_hand.empty() ? compressed_->peek(1) : at_hand;
    if (compressed_->lost()) failure_ = kLost;
    if (there.empty() && compressed_->failure()) failure_ = *compressed_->failure();
    if (there.empty()) return {};
    const Bytes all = compressed_->at_hand();
    return all.first(std::min<std::size_t>(all.size(), std::numeric_limits<unsigned>::max() / 2));
  }
  std::size_t fail(std::string what) {
    if (!failure_)
      failure_ = std::move(what) + " (byte " + std::to_string(compressed_->position()) + " of the compressed file)";
    return 0;
  }

  std::unique_ptr<Input> compressed_;
};

class GzipInput final : public Decompressed {
 public:
  explicit GzipInput(std::unique_ptr<Input> compressed) : Decompressed(std::move(compressed)) {
    constexpr int kGzipOnly = 16;
    ready_ = ::inflateInit2(&stream_, MAX_WBITS + kGzipOnly) == Z_OK;
  }
  ~GzipInput() override {
    if (ready_) ::inflateEnd(&stream_);
  }

 private:
  std::size_t fill(MutableBytes into) override {
    if (!ready_) return fail("no memory to unpack the gzip stream");
    stream_.next_out = into.data();
    stream_.avail_out = static_cast<unsigned>(std::min<std::size_t>(into.size(), std::numeric_limits<unsigned>::max()));
    const unsigned room = stream_.avail_out;
    while (stream_.avail_out == room) {
      const Bytes bytes = more();
      if (failure_) return 0;
      if (bytes.empty()) return inside_ ? fail("the gzip stream ends early") : 0;
      if (!inside_ && bytes[0] == 0) {  // padding of a tape or a block device
        compressed_->skip(1);
        continue;
      }
      inside_ = true;
      stream_.next_in = const_cast<Bytef*>(bytes.data());
      stream_.avail_in = static_cast<unsigned>(bytes.size());
      const int result = ::inflate(&stream_, Z_NO_FLUSH);
      compressed_->skip(bytes.size() - stream_.avail_in);
      if (result == Z_STREAM_END) {
        inside_ = false;
        ::inflateReset(&stream_);
      } else if (result != Z_OK) {
        return fail("the gzip stream is damaged");
      }
    }
    return room - stream_.avail_out;
  }

  z_stream stream_ = {};
  bool ready_ = false;
  bool inside_ = false;  // a member
};

class ZstdInput final : public Decompressed {
 public:
  explicit ZstdInput(std::unique_ptr<Input> compressed)
      : Decompressed(std::move(compressed)), stream_(::ZSTD_createDStream()) {
    if (stream_ != nullptr) ::ZSTD_DCtx_setParameter(stream_, ZSTD_d_windowLogMax, kMaxWindowLog);
  }
  ~ZstdInput() override { ::ZSTD_freeDStream(stream_); }

 private:
  std::size_t fill(MutableBytes into) override {
    if (stream_ == nullptr) return fail("no memory to unpack the zstd stream");
    ZSTD_outBuffer out{into.data(), into.size(), 0};
    while (out.pos == 0) {
      const Bytes bytes = more();
      if (failure_) return 0;
      // An ended input may still leave output inside the decoder.
      ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
      if (bytes.empty() && !inside_) return 0;
      const std::size_t result = ::ZSTD_decompressStream(stream_, &out, &in);
      compressed_->skip(in.pos);
      if (::ZSTD_isError(result) != 0) {
        const bool window = ::ZSTD_getErrorCode(result) == ZSTD_error_frameParameter_windowTooLarge;
        return fail(window ? "the zstd stream needs a window of more than 32 MiB; unpack it: zstd -d --long=31"
                           : "the zstd stream is damaged");
      }
      inside_ = result != 0;
      if (bytes.empty() && out.pos == 0) return inside_ ? fail("the zstd stream ends early") : 0;
    }
    return out.pos;
  }

  ZSTD_DStream* stream_;
  bool inside_ = false;  // a frame
};

}  // namespace

std::unique_ptr<Input> gzip_input(std::unique_ptr<Input> compressed) {
  return std::make_unique<GzipInput>(std::move(compressed));
}
std::unique_ptr<Input> zstd_input(std::unique_ptr<Input> compressed) {
  return std::make_unique<ZstdInput>(std::move(compressed));
}

}  // namespace servotrace::replay
