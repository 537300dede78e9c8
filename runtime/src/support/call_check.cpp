#include "support/call_check.h"

#include <fmt/format.h>

#include <utility>

#include "galactic/error.h"

namespace galactic::detail {

void refuseCall(const char* call, std::string message) {
  throw ErrorException({ErrorCode::kInvalidInput, call, std::move(message)});
}

void refuseLength(const char* call, const char* array, std::size_t found, std::size_t expected) {
  refuseCall(call, fmt::format("\"{}\" has the length {}, expected {}", array, found, expected));
}

void refuseIndex(const char* call, const char* index, std::size_t found, std::size_t count) {
  refuseCall(call, fmt::format("found {} {}, expected one below {}", index, found, count));
}

}  // namespace galactic::detail
