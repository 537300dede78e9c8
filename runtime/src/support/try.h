#pragma once
#include <tl/expected.hpp>
#include <utility>

// Macros that pass errors on, under the names that Abseil made common. For the sources of this
// project only: macros have no namespace, so no public header includes this one.

#define GALACTIC_JOINED_AGAIN(a, b) a##b
#define GALACTIC_JOINED(a, b) GALACTIC_JOINED_AGAIN(a, b)

/// RETURN_IF_ERROR(checkOptions(options)); returns the error of a Result, if there is one.
#define RETURN_IF_ERROR(...)                           \
  do {                                                 \
    if (auto tried = (__VA_ARGS__); !tried) {          \
      return tl::unexpected(std::move(tried).error()); \
    }                                                  \
  } while (false)

/// ASSIGN_OR_RETURN(auto mesh, importMesh(path)); returns the error of a Result, or declares its
/// value.
#define ASSIGN_OR_RETURN(declaration, ...) \
  GALACTIC_ASSIGN_OR_RETURN(GALACTIC_JOINED(tried_, __LINE__), declaration, __VA_ARGS__)
#define GALACTIC_ASSIGN_OR_RETURN(tried, declaration, ...)     \
  auto tried = (__VA_ARGS__);                                  \
  if (!tried) return tl::unexpected(std::move(tried).error()); \
  declaration = *std::move(tried)
