#include "support/build_paths.h"

namespace galactic::test {

std::filesystem::path sourceFolder() { return GALACTIC_SOURCE_DIR; }
std::filesystem::path programFolder() { return GALACTIC_PROGRAM_DIR; }
std::string builtProgram(std::string_view name) { return programFolder() / name; }
std::string cudaStandIn() { return GALACTIC_CUDA_STANDIN; }

}  // namespace galactic::test
