// SPDX-License-Identifier: MIT
// One readable sentence a frame, made from its dissection: `decode`, the evidence of findings, Wireshark's Info column.
#pragma once

#include <string>

#include "decoder/pipeline/dissection.hpp"
#include "decoder/pipeline/settings.hpp"

namespace servotrace {

// The whole frame. Empty where nothing was recognised. `settings` names nodes; nullptr: by number only.
std::string sentence(const Dissection& dissection, const Settings* settings = nullptr);

// What the frame says about one node only (an RTEX record holds many); the whole frame where the node is a bus or has
// no part of its own.
std::string sentence_of(const Dissection& dissection, const NodeRef& node, const Settings* settings = nullptr);

}  // namespace servotrace
