#pragma once
#include <string>
#include <string_view>

#include "galactic/error.h"

namespace galactic::bake {

/// Whether a PLY file holds as many elements as its header states. Fails with kInvalidInput on a
/// header without an end or of more than 10,000 lines, on a file that ends before the last element,
/// and on one in which another element would fit behind it. What is no PLY passes: the reader says
/// so. `where` is for messages.
[[nodiscard]] Result<void> checkPlyCounts(std::string_view file, const std::string& where);

}  // namespace galactic::bake
