// SPDX-License-Identifier: MIT
// A dissection in full, field by field, as text.
#pragma once

#include <string>

#include "decoder/pipeline/dissection.hpp"
#include "decoder/pipeline/settings.hpp"

namespace servotrace {

struct TextOptions {
  bool explanations = false;  // what a value means, and the manual's section, behind each field
  bool reserved = false;      // reserved bits that are 0, too
};

// Appends one indented line a field, under one line a segment; then derived values and links.
void append_text(std::string& out, const Dissection& dissection, const Settings& settings,
                 const TextOptions& options = {});

// "request in", "accepted in" ...
std::string_view name_of(LinkKind kind);

}  // namespace servotrace
