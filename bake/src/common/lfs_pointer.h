#pragma once
#include <string_view>

namespace galactic::bake {

/// How a file begins that Git LFS left in place of the real one.
inline constexpr std::string_view kLfsSignature = "version https://git-lfs";
/// What to say of such a file.
inline constexpr std::string_view kLfsPointer = "a pointer of Git LFS (fetch it with git lfs pull)";

}  // namespace galactic::bake
