// SPDX-License-Identifier: MIT
// What no single message of the ESB holds: transactions and programs.
#pragma once

#include "decoder/core/layout.hpp"

namespace servotrace::esb {

inline constexpr Field kTransaction{.key = "transaction",
                                    .label = "Transaction",
                                    .kind = Kind::kText,
                                    .section = "ESB 5.2",
                                    .explanation = "What PRM_REQ asks for, and with the answer its result."};
inline constexpr Field kTransactionTime{.key = "transaction_time",
                                        .label = "Time to PRM_ACK",
                                        .width = 64,
                                        .kind = Kind::kUnsigned,
                                        .unit = Unit::kNanosecond,
                                        .section = "ESB 5.2.1"};
inline constexpr Field kListing{.key = "listing",
                                .label = "Program",
                                .kind = Kind::kText,
                                .section = "ESB 5.3, 5.4.5",
                                .explanation = "The channel as far as the capture shows it."};
inline constexpr const Field* kDerived[] = {&kTransaction, &kTransactionTime, &kListing};

}  // namespace servotrace::esb
