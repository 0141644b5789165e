// SPDX-License-Identifier: MIT
// Several files of one recording as one source, merged by time.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "replay/capture/source.hpp"

namespace servotrace::replay {

// Frames come in the order of their times; equal times in the order of `paths`. They are numbered anew, as mergecap
// would number them. An interface of a file continues one of an earlier file of the same link type and name where that
// file has ended (a ring buffer of files); where the two overlap in time they are two interfaces. At such a border
// dropped() holds an entry of count 0: what follows must not be compared with what came before. Files are opened when
// their time comes, so that thousands of them need neither memory nor descriptors.
Result<std::unique_ptr<Source>> join_captures(const std::vector<std::filesystem::path>& paths);

}  // namespace servotrace::replay
