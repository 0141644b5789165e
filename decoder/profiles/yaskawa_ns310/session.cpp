// SPDX-License-Identifier: MIT
#include "decoder/profiles/yaskawa_ns310/profile.hpp"

namespace servotrace::ns310 {

std::unique_ptr<DriveSession> make_session(const Settings&, const NodeRef&, OwnerId, bool) { return nullptr; }

}  // namespace servotrace::ns310
