// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <zlib.h>
#include <zstd.h>

#include "tests/support/bytes.hpp"
#include "tests/unit/capture/support.hpp"

namespace servotrace::test {
namespace {

Buffer capture_bytes(int frames) {
  Maker maker;
  maker.section().interface(227);
  for (int i = 0; i < frames; ++i)
    maker.enhanced(0, static_cast<std::uint64_t>(i) * 7919,
                   Maker().u32(static_cast<std::uint32_t>(i) * 2654435761U).bytes(), 4);
  return maker.bytes();
}

Buffer gzip(Bytes bytes) {
  z_stream stream = {};
  EXPECT_EQ(deflateInit2(&stream, 6, Z_DEFLATED, MAX_WBITS + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
  Buffer out(deflateBound(&stream, bytes.size()) + 64);
  stream.next_in = const_cast<Bytef*>(bytes.data());
  stream.avail_in = static_cast<unsigned>(bytes.size());
  stream.next_out = out.data();
  stream.avail_out = static_cast<unsigned>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

Buffer zstd(Bytes bytes) {
  ZSTD_CCtx* const context = ZSTD_createCCtx();
  ZSTD_CCtx_setParameter(context, ZSTD_c_checksumFlag, 1);  // as zstd(1) does
  Buffer out(ZSTD_compressBound(bytes.size()));
  out.resize(ZSTD_compress2(context, out.data(), out.size(), bytes.data(), bytes.size()));
  ZSTD_freeCCtx(context);
  return out;
}

constexpr int kFrames = 30'000;  // several chunks

TEST(Compressed, GzipAndZstdReadLikeTheFile) {
  const Buffer plain = capture_bytes(kFrames);
  const ReadCapture expected = read_stream(plain, 1 << 16);
  ASSERT_EQ(expected.frames.size(), static_cast<std::size_t>(kFrames));
  const Buffer packed[] = {gzip(plain), zstd(plain), gzip(zstd(plain))};
  const char* const formats[] = {"pcapng (gzip)", "pcapng (zstd)", "pcapng (gzip) (zstd)"};
  for (std::size_t k = 0; k < 3; ++k) {
    const ReadCapture capture = read_both(packed[k]);
    EXPECT_EQ(capture.error, "");
    EXPECT_EQ(capture.format, formats[k]);
    EXPECT_FALSE(capture.truncation);
    ASSERT_EQ(capture.frames.size(), expected.frames.size());
    for (std::size_t i = 0; i < expected.frames.size(); ++i) {
      ASSERT_EQ(capture.frames[i].bytes, expected.frames[i].bytes);
      ASSERT_EQ(capture.frames[i].byte_offset, expected.frames[i].byte_offset);
    }
  }
}

TEST(Compressed, SeveralMembersAreOneStream) {
  const Buffer plain = capture_bytes(100);
  const Bytes first = Bytes(plain).first(777);
  const Bytes second = Bytes(plain).subspan(777);
  for (Buffer (*const pack)(Bytes) :
       {+[](Bytes bytes) { return gzip(bytes); }, +[](Bytes bytes) { return zstd(bytes); }}) {
    Buffer both = pack(first);
    const Buffer more = pack(second);
    both.insert(both.end(), more.begin(), more.end());
    const ReadCapture capture = read_both(both);
    EXPECT_EQ(capture.error, "");
    EXPECT_EQ(capture.frames.size(), 100U);
  }
  Buffer padded = gzip(plain);
  padded.resize(padded.size() + 512);
  EXPECT_EQ(read_both(padded).error, "");
}

TEST(Compressed, ACutStreamIsAnErrorBehindWhatHolds) {
  const Buffer plain = capture_bytes(kFrames);
  for (const Buffer& packed : {gzip(plain), zstd(plain)}) {
    const ReadCapture capture = read_both(Bytes(packed).first(packed.size() / 2));
    EXPECT_NE(capture.error.find("stream ends early (byte " + std::to_string(packed.size() / 2)), std::string::npos)
        << capture.error;
    EXPECT_GT(capture.frames.size(), 100U);
    EXPECT_LT(capture.frames.size(), static_cast<std::size_t>(kFrames));
  }
}

TEST(Compressed, ADamagedStreamIsAnError) {
  const Buffer plain = capture_bytes(kFrames);
  for (Buffer packed : {gzip(plain), zstd(plain)}) {
    for (std::size_t i = packed.size() / 2; i < packed.size() / 2 + 64; ++i) packed[i] = 0xFF;
    const TemporaryFolder folder;
    EXPECT_NE(read_file(folder.file("damaged", packed)).error.find("damaged"), std::string::npos);
    EXPECT_NE(read_stream(packed, 4096).error, "");
  }
}

TEST(Compressed, HugeWindowsAreRefused) {
  ZSTD_CCtx* const context = ZSTD_createCCtx();
  ZSTD_CCtx_setParameter(context, ZSTD_c_windowLog, 27);
  ZSTD_CCtx_setParameter(context, ZSTD_c_contentSizeFlag, 0);
  const Buffer plain(1000);
  Buffer out(1000);
  ZSTD_inBuffer in{plain.data(), plain.size(), 0};
  ZSTD_outBuffer to{out.data(), out.size(), 0};
  ZSTD_compressStream2(context, &to, &in, ZSTD_e_continue);
  ZSTD_compressStream2(context, &to, &in, ZSTD_e_end);
  ZSTD_freeCCtx(context);
  out.resize(to.pos);
  const ReadCapture capture = read_both(out);
  EXPECT_NE(capture.error.find("window of more than 32 MiB"), std::string::npos) << capture.error;
}

TEST(Compressed, ThriceIsRefused) {
  EXPECT_EQ(read_both(gzip(gzip(gzip(capture_bytes(1))))).error, "-: is compressed more than twice");
}

}  // namespace
}  // namespace servotrace::test
