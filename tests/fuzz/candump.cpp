// SPDX-License-Identifier: MIT
// Lines of a candump log behind a good one, so that the content is recognised as such a log.
#include <cstdlib>
#include <string>

#include "tests/support/harness.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string text = "(1700000000.000000) can0 405#C0\n";
  text.append(reinterpret_cast<const char*>(data), size);
  const servotrace::Bytes bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  const auto outcome = servotrace::test::check_bytes(bytes);
  if (!outcome.nonsense.empty() || (outcome.frames == 0 && !outcome.broken)) std::abort();
  return 0;
}
