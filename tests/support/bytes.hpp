// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace servotrace::test {

// "81 2A FF" to bytes; everything but hexadecimal digits is passed over.
std::vector<std::uint8_t> hex(std::string_view text);

}  // namespace servotrace::test
