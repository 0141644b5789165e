// SPDX-License-Identifier: MIT
// Compressed captures. An even first byte: the rest is the stream itself, behind the magic number of gzip or zstd. An
// odd one: the rest is compressed here, so that what lies in a good stream is reached.
#include <zlib.h>
#include <zstd.h>

#include <cstdlib>
#include <vector>

#include "tests/support/harness.hpp"

namespace {

std::vector<std::uint8_t> gzip(servotrace::Bytes bytes) {
  constexpr int kGzip = 15 + 16;  // window bits, gzip instead of zlib
  z_stream stream = {};
  if (deflateInit2(&stream, 1, Z_DEFLATED, kGzip, 8, Z_DEFAULT_STRATEGY) != Z_OK) std::abort();
  std::vector<std::uint8_t> packed(deflateBound(&stream, static_cast<uLong>(bytes.size())) + 64);
  std::vector<std::uint8_t> plain(bytes.begin(), bytes.end());
  stream.next_in = plain.data();
  stream.avail_in = static_cast<uInt>(plain.size());
  stream.next_out = packed.data();
  stream.avail_out = static_cast<uInt>(packed.size());
  if (deflate(&stream, Z_FINISH) != Z_STREAM_END) std::abort();
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

std::vector<std::uint8_t> zstd(servotrace::Bytes bytes) {
  std::vector<std::uint8_t> packed(ZSTD_compressBound(bytes.size()));
  const std::size_t length = ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 1);
  if (ZSTD_isError(length) != 0U) std::abort();
  packed.resize(length);
  return packed;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const bool is_zstd = (data[0] & 2U) != 0;
  const servotrace::Bytes rest(data + 1, size - 1);
  std::vector<std::uint8_t> file;
  if ((data[0] & 1U) != 0) {
    file = is_zstd ? zstd(rest) : gzip(rest);
    // A stream that is cut must be told from one that ends.
    if ((data[0] & 4U) != 0) file.resize(file.size() / 2);
  } else {
    file = is_zstd ? std::vector<std::uint8_t>{0x28, 0xB5, 0x2F, 0xFD} : std::vector<std::uint8_t>{0x1F, 0x8B};
    file.insert(file.end(), rest.begin(), rest.end());
  }
  if (!servotrace::test::check_bytes(file).nonsense.empty()) std::abort();
  return 0;
}
