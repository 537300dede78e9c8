#pragma once
#include <string>
#include <string_view>

#include "galactic/error.h"

namespace galactic::bake {

// Whether mesh files are whole, as far as they tell. Each fails with kInvalidInput; what it cannot
// judge passes to the reader. `where` is for messages.

/// An OBJ does not end inside a statement, its faces use vertices that it has, and it names at most
/// 1000 material files. A last line without an end is no offence if it can be whole: published
/// models have such.
[[nodiscard]] Result<void> checkObj(std::string_view file, const std::string& where);

/// A binary STL has the size of the triangles that it states; in one of text every solid, and every
/// facet of three vertices, is closed.
[[nodiscard]] Result<void> checkStl(std::string_view file, const std::string& where);

/// An OFF file has as many vertices and faces as it states.
[[nodiscard]] Result<void> checkOff(std::string_view file, const std::string& where);

}  // namespace galactic::bake
