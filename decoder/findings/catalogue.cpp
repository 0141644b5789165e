// SPDX-License-Identifier: MIT
#include "decoder/findings/catalogue.hpp"

namespace servotrace {
namespace {
consteval bool slugs_are_unique() {
  for (std::size_t i = 0; i < kRuleCount; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      // The same slug may name the same thing of another block (RX902 and YS901 are both "alarm").
      if (kCatalogue[i].slug == kCatalogue[j].slug && kCatalogue[i].id.substr(0, 2) == kCatalogue[j].id.substr(0, 2))
        return false;
    }
  }
  return true;
}
}  // namespace
static_assert(slugs_are_unique(), "two rules of a block share a slug");
}  // namespace servotrace
