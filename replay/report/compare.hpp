// SPDX-License-Identifier: MIT
// Where two captures of the same machine part: a good run beside a bad one.
#pragma once

#include "replay/report/model.hpp"

namespace servotrace::report {

// Nodes are taken for the same by kind and number of their bus and by MAC-ID. Times play no part: what counts is the
// order of the states, so that a slower run does not differ.
Comparison compare(const Model& here, const Model& there);

}  // namespace servotrace::report
