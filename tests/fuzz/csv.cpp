// SPDX-License-Identifier: MIT
// Tables of CAN frames: the input's first line is a header of columns, the others are rows; a fixed header is tried,
// too, for rows of which the header says nothing.
#include <cstdlib>
#include <string>

#include "replay/capture/csv.hpp"
#include "tests/support/harness.hpp"

namespace {

void check(const std::string& text) {
  const servotrace::Bytes bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  if (!servotrace::test::check_bytes(bytes).nonsense.empty()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto header = servotrace::replay::parse_csv_header(std::string_view(text).substr(0, text.find('\n')));
  if (header && (header->columns.empty() || header->time_unit_ns <= 0)) std::abort();
  check(text);
  check("timestamp,arbitration_id,extended,remote,error,dlc,data\n" + text);
  return 0;
}
