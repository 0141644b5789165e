// SPDX-License-Identifier: MIT
#include <utility>

#include "replay/capture/readers.hpp"
#include "replay/capture/recognise.hpp"

namespace servotrace::replay {
namespace {

Result<std::unique_ptr<Source>> open(std::unique_ptr<Input> input, std::string name) {
  const Result<Kind> kind = recognise(*input, name);
  if (!kind) return kind.error();
  switch (kind.value()) {
    case Kind::kPcap:
      return read_pcap(std::move(input), std::move(name), "pcap");
    case Kind::kPcapng:
      break;
  }
  return read_pcapng(std::move(input), std::move(name), "pcapng");
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
