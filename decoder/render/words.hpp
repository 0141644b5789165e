// SPDX-License-Identifier: MIT
// The words of sentences: what of a field is worth one, and how words are joined.
#pragma once

#include <string>
#include <string_view>

#include "decoder/pipeline/dissection.hpp"
#include "decoder/pipeline/settings.hpp"

namespace servotrace {

void join(std::string& text, std::string_view separator, std::string_view part);

// A node as the settings call it; nullptr: by number only.
std::string name_text(const NodeRef& node, const Settings* settings);

// The manual's abbreviation where a label holds one: "CPOS" of "Command position (CPOS)", "SVON" of "SVON (Servo ON)".
std::string_view short_label(std::string_view label);
// A name of capital letters, as drives' signals have.
bool is_abbreviation(std::string_view word);

// The value of a field with its unit, as a sentence says it: torque in %, positions without "command units".
std::string quantity_text(const Field& field, std::int64_t raw);

bool is_flag(const Field& field);
// Equal but for capital letters.
bool same_letters(std::string_view left, std::string_view right);

// A field's word; empty where it is worth none. `under` are the field's own bytes.
std::string field_word(const Field& field, std::int64_t raw, Bytes under);
// A segment that is but one quantity with a unit; else empty.
std::string lone_quantity(const Segment& segment, Bytes bytes);
// What of a segment is worth a word: named values, process values, flags that are set.
std::string segment_words(const Segment& segment, Bytes bytes);

// The first value of this key; nullptr where there is none.
const Derived* find_derived(const Dissection& dissection, std::string_view key);

// The two kinds of sentences.
std::string block_sentence(const Dissection& dissection, const NodeRef& node, const Settings* settings);  // RTEX
std::string devicenet_sentence(const Dissection& dissection, const Settings* settings);

}  // namespace servotrace
