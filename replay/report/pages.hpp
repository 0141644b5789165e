// SPDX-License-Identifier: MIT
// The report as text: one self-contained HTML file, Markdown, and the model itself as JSON.
#pragma once

#include <span>
#include <string>

#include "decoder/pipeline/settings.hpp"
#include "replay/report/build.hpp"

namespace servotrace::report {

// Several captures: an overview, then each.
std::string html(std::span<const Built> captures, const Settings& settings);
std::string markdown(std::span<const Built> captures, const Settings& settings);
std::string json(std::span<const Built> captures, const Settings& settings);

// "likely", "possible"
std::string_view evidence_word(const Candidate& candidate);
// Basis in words: "configured", "shown by frame 12", "assumed"; empty for kNone.
std::string basis_text(const Basis& basis);

}  // namespace servotrace::report
