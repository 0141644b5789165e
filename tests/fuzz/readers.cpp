// SPDX-License-Identifier: MIT
// Bytes of a file of any kind through the readers and a pipeline.
#include <cstdlib>

#include "tests/support/harness.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (!servotrace::test::check_bytes({data, size}).nonsense.empty()) std::abort();
  return 0;
}
