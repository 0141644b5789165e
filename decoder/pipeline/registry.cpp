// SPDX-License-Identifier: MIT
#include "decoder/pipeline/registry.hpp"

#include <iterator>

#include "decoder/devicenet/layouts.hpp"
#include "decoder/profiles/profile.hpp"
#include "decoder/profiles/profiles.hpp"
#include "decoder/rtex/layouts.hpp"

namespace servotrace {

std::vector<const Layout*> all_layouts() {
  std::vector<const Layout*> all;
  const auto append = [&all](std::span<const Layout* const> layouts) {
    all.insert(all.end(), layouts.begin(), layouts.end());
  };
  append(rtex::layouts());
  append(devicenet::layouts());
  for (const DriveProfile* profile : profiles()) append(profile->layouts);
  return all;
}

std::vector<DerivedField> all_derived() {
  std::vector<DerivedField> all;
  for (const Field* field : rtex::derived()) all.push_back({"rtex", field});
  for (const Field* field : devicenet::derived()) all.push_back({"dnet", field});
  for (const DriveProfile* profile : profiles()) {
    for (const Field* field : profile->derived) all.push_back({profile->protocol, field});
  }
  return all;
}

std::vector<std::string_view> profile_keys() {
  std::vector<std::string_view> keys;
  keys.reserve(profiles().size() + 1);
  for (const DriveProfile* profile : profiles()) keys.push_back(profile->key);
  keys.push_back("generic");
  return keys;
}

}  // namespace servotrace
