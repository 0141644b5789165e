// SPDX-License-Identifier: MIT
// Whether this build has the address sanitizer, of g++ or of clang: memory then says nothing, and work takes its time.
#pragma once

namespace servotrace::test {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace servotrace::test
