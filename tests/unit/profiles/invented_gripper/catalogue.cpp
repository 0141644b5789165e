// SPDX-License-Identifier: MIT
// Built with profiles.hpp and one profile more on its list: its rules are in the catalogue without another line,
// between the blocks of the others. The compiler is the judge; nothing of this is linked.
#include "decoder/findings/catalogue.hpp"

namespace servotrace {

static_assert(rule_row(rule("GR101")).slug == "closed-on-nothing");
static_assert(rule_row(rule("GR901")).actor == Actor::kDrive);
static_assert(rule("DN405") < rule("GR101") && rule("GR901") < rule("NK101"));
static_assert(rule_row(rule("NK101")).slug == "request-not-idle" && rule_row(rule("YS905")).slug == "block-fault");
static_assert(detail::legal(kCatalogue));

}  // namespace servotrace
