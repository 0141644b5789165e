// SPDX-License-Identifier: MIT
#include "decoder/rtex/layouts.hpp"

#include "decoder/link/rtex_record.hpp"

namespace servotrace::rtex {

std::span<const Layout* const> layouts() {
  static constexpr const Layout* kAll[] = {&kRecord};
  return kAll;
}
std::span<const Field* const> derived() { return {}; }

}  // namespace servotrace::rtex
