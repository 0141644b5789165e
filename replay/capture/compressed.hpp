// SPDX-License-Identifier: MIT
// gzip and zstd streams as inputs. Several members or frames one behind the other are one stream. A stream that ends
// early or is damaged is a failure(): what came before holds.
#pragma once

#include <memory>

#include "replay/capture/input.hpp"

namespace servotrace::replay {

std::unique_ptr<Input> gzip_input(std::unique_ptr<Input> compressed);
std::unique_ptr<Input> zstd_input(std::unique_ptr<Input> compressed);

}  // namespace servotrace::replay
