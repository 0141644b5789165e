// SPDX-License-Identifier: GPL-2.0-or-later
// Texts for the tree, made by the decoder's own renderers and copied into Wireshark's memory of the packet. The strings
// they are made with are gone before Wireshark is called again.
#pragma once

#include <string>

#include "decoder/findings/finding.hpp"
#include "decoder/pipeline/dissection.hpp"
#include "dissector/ws.hpp"

namespace servotrace::plugin {

// A copy that ends in a zero.
const char* pool_text(wmem_allocator_t* pool, std::string_view text);

const char* message_text(wmem_allocator_t* pool, const Finding& finding);

// What stands behind a field's raw value: " (45 r/min)" where the row scales it, " r/min" where it has but a unit, ""
// where it has none; of a time " ns (0.5 ms)".
const char* unit_text(wmem_allocator_t* pool, const Field& field, std::int64_t value);

// "axis 3 (X)", "ring0", "can1", "capture".
const char* node_text(wmem_allocator_t* pool, const NodeRef& node);

// Who sent the frame and to whom, for the address columns: "master", "axis 3 (X)", "ring0". Empty: not known.
struct Ends {
  std::string source;
  std::string destination;
};
Ends ends_text(const Dissection& dissection);

// The info column: a sentence. Empty where nothing was recognised.
std::string info_text(const Dissection& dissection);

}  // namespace servotrace::plugin
