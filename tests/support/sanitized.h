#pragma once

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define GALACTIC_TEST_IS_SANITIZED true
#endif
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define GALACTIC_TEST_IS_SANITIZED true
#endif
#ifndef GALACTIC_TEST_IS_SANITIZED
#define GALACTIC_TEST_IS_SANITIZED false
#endif

namespace galactic::test {

/// Whether a sanitizer watches, with which a test takes up to ten times as long.
inline constexpr bool kIsSanitized = GALACTIC_TEST_IS_SANITIZED;

}  // namespace galactic::test

#undef GALACTIC_TEST_IS_SANITIZED
