// SPDX-License-Identifier: MIT
// The drive profile yaskawa-ns310.
#pragma once

#include "decoder/profiles/profile.hpp"
#include "decoder/profiles/yaskawa_ns310/derived.hpp"
#include "decoder/profiles/yaskawa_ns310/layouts.hpp"
#include "decoder/profiles/yaskawa_ns310/objects.hpp"

namespace servotrace::ns310 {

std::unique_ptr<DriveSession> make_session(const Settings& settings, const NodeRef& node, OwnerId owner,
                                           bool decode_only);

// The manual prints 44h (SIE-C718-7 B.1); the number the maker holds is decimal 44.
inline constexpr std::uint16_t kVendorIds[] = {44, 0x44};

namespace detail {
consteval auto all_layouts() {
  std::array<const Layout*, std::size(kAssemblyLayouts) + kBlockLayouts.size() + objects::kLayouts.size()> all{};
  std::size_t next = 0;
  for (const Layout* layout : kAssemblyLayouts) all[next++] = layout;
  for (const Layout& layout : kBlockLayouts) all[next++] = &layout;
  for (const Layout* layout : objects::kLayouts) all[next++] = layout;
  return all;
}
}  // namespace detail
inline constexpr auto kLayouts = detail::all_layouts();

inline constexpr DriveProfile kProfile{
    .key = "yaskawa-ns310",
    .title = "Yaskawa SGDH with NS310",
    .protocol = "ns310",
    .command_size = 8,
    .response_size = 8,
    .vendor_ids = kVendorIds,
    .product_code = 0x51,
    .product_name = "JUSP-NS310",
    .objects = objects::kClasses,
    .layouts = kLayouts,
    .derived = kDerived,
    .make_session = &make_session,
};

}  // namespace servotrace::ns310
