// SPDX-License-Identifier: MIT
#include "decoder/profiles/nsk_esb/profile.hpp"

namespace servotrace::esb {

std::unique_ptr<DriveSession> make_session(const Settings&, const NodeRef&, OwnerId, bool) { return nullptr; }

}  // namespace servotrace::esb
