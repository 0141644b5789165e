// SPDX-License-Identifier: MIT
// How a node is called: "axis 3 (X)", "node 5 (indexer)".
#pragma once

#include <string>
#include <string_view>

#include "decoder/findings/finding.hpp"
#include "decoder/pipeline/settings.hpp"

namespace servotrace {

// The name the settings give the node; empty where they give none. Lives as long as the settings.
std::string_view configured_name(const Settings& settings, const NodeRef& node);

// "axis 3 (X)", "node 5", without a name where it is empty; empty for a whole bus.
std::string node_text(const NodeRef& node, std::string_view name = {});

}  // namespace servotrace
