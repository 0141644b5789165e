// SPDX-License-Identifier: MIT
#include "decoder/findings/catalogue.hpp"

namespace servotrace {
namespace {
consteval bool slugs_are_unique() {
  for (std::size_t i = 0; i < kRuleCount; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (kCatalogue[i].slug == kCatalogue[j].slug) return false;
    }
  }
  return true;
}
}  // namespace
static_assert(slugs_are_unique(), "two rules share a slug");
}  // namespace servotrace
