// SPDX-License-Identifier: MIT
// The word a mistyped one was meant to be.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace servotrace::replay {

// Edits between two words: letters put in, left out, changed or swapped with their neighbour. Capitals do not count.
std::size_t edit_distance(std::string_view left, std::string_view right);

// The candidate nearest to `word`, where it is near enough to be meant (a third of its letters, at least one), else the
// first that begins with it (three letters at least); else empty. The earlier of two equally near ones.
std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates);

// " (did you mean 'name'?)", or empty.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace servotrace::replay
