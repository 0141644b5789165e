// SPDX-License-Identifier: MIT
#include <utility>

#include "replay/capture/compressed.hpp"
#include "replay/capture/readers.hpp"
#include "replay/capture/recognise.hpp"

namespace servotrace::replay {
namespace {

constexpr int kMaxLayers = 2;  // of compression

Result<std::unique_ptr<Source>> open(std::unique_ptr<Input> input, std::string name) {
  std::string packed;  // behind the format's name
  for (int layers = 0;; ++layers) {
    const Result<Kind> kind = recognise(*input, name);
    if (!kind) return kind.error();
    if (layers == kMaxLayers && (kind.value() == Kind::kGzip || kind.value() == Kind::kZstd))
      return Error{name, "is compressed more than twice"};
    switch (kind.value()) {
      case Kind::kPcap:
        return read_pcap(std::move(input), std::move(name), "pcap" + packed);
      case Kind::kPcapng:
        return read_pcapng(std::move(input), std::move(name), "pcapng" + packed);
      case Kind::kCandump:
        return read_candump(std::move(input), std::move(name), "candump log" + packed);
      case Kind::kAsc:
        return read_asc(std::move(input), std::move(name), "Vector ASC" + packed);
      case Kind::kTrc:
        return read_trc(std::move(input), std::move(name), "PEAK TRC" + packed);
      case Kind::kCsv:
        return read_csv(std::move(input), std::move(name), "CSV" + packed);
      case Kind::kGzip:
        input = gzip_input(std::move(input));
        packed += " (gzip)";
        break;
      case Kind::kZstd:
        input = zstd_input(std::move(input));
        packed += " (zstd)";
        break;
    }
  }
}

}  // namespace

Result<std::unique_ptr<Source>> open_capture(const std::filesystem::path& path) {
  Result<std::unique_ptr<Input>> input = open_input(path);
  if (!input) return input.error();
  return open(std::move(input.value()), path.string());
}

Result<std::unique_ptr<Source>> open_stream(int descriptor, std::string name) {
  return open(descriptor_input(descriptor), std::move(name));
}

Result<std::unique_ptr<Source>> open_bytes(Bytes bytes, std::string name) {
  return open(memory_input(bytes), std::move(name));
}

}  // namespace servotrace::replay
