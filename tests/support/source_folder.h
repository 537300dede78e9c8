#pragma once
#include <filesystem>

namespace galactic::test {

/// The checkout that the tests were built from. Known to one object file only, so that checkouts
/// share the others in the compiler's cache.
std::filesystem::path sourceFolder();

}  // namespace galactic::test
