#pragma once
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>

namespace galactic::test {

/// All bytes of a file; empty when there is none.
inline std::string fileContent(const std::filesystem::path& path) {
  std::ostringstream content;
  content << std::ifstream(path, std::ios::binary).rdbuf();
  return std::move(content).str();
}

}  // namespace galactic::test
