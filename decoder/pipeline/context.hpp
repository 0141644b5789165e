// SPDX-License-Identifier: MIT
// What every stage below the pipeline is handed with a frame.
#pragma once

#include "decoder/findings/repeat.hpp"
#include "decoder/link/raw_frame.hpp"
#include "decoder/pipeline/dissection.hpp"
#include "decoder/pipeline/settings.hpp"

namespace servotrace {

struct Context {
  const RawFrame& frame;
  const Settings& settings;
  Findings& findings;
  Dissection* dissection = nullptr;  // nullptr: nobody looks, add nothing
};

}  // namespace servotrace
