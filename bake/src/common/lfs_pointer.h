#pragma once
#include <string_view>

namespace galactic::bake {

/// The beginning of a pointer file that Git LFS leaves in place of the real file.
inline constexpr std::string_view kLfsSignature = "version https://git-lfs";
/// How messages describe such a file.
inline constexpr std::string_view kLfsPointer = "a pointer of Git LFS (fetch it with git lfs pull)";

}  // namespace galactic::bake
