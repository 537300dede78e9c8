#pragma once
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "galactic/error.h"

namespace galactic::test {

/// Ends the target: the input that it was given goes against what was promised.
[[noreturn]] inline void reportFinding(std::string_view finding) {
  std::fprintf(stderr, "finding: %.*s\n", static_cast<int>(finding.size()), finding.data());
  std::abort();
}

/// Whatever an input is, it is the input's fault, and the error says where and what.
inline void expectGoodError(const Error& error) {
  if (error.code == ErrorCode::kInternal) reportFinding(error.message);
  if (error.where.empty() || error.message.empty()) {
    reportFinding("an error without place or message");
  }
}

}  // namespace galactic::test
