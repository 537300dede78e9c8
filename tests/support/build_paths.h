#pragma once
#include <filesystem>
#include <string>
#include <string_view>

/// Where this build and its sources lie. Known to one object file only, so that checkouts share the
/// others in the compiler's cache.
namespace galactic::test {

/// The checkout that the tests were built from.
std::filesystem::path sourceFolder();

/// The folder of this build's programs.
std::filesystem::path programFolder();

/// The program of this build with this name, such as "galactic-run".
std::string builtProgram(std::string_view name);

/// The library that stands in for the CUDA driver and runs its kernels on the processor.
std::string cudaStandIn();

}  // namespace galactic::test
