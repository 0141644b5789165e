// SPDX-License-Identifier: MIT
// Settings and frames straight into a pipeline.
#include <cstdlib>

#include "tests/support/harness.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (!servotrace::test::check_frames({data, size}).nonsense.empty()) std::abort();
  return 0;
}
