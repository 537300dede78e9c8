#pragma once
#include <string>
#include <utility>
#include <vector>

#include "galactic/bake/source_asset.h"

namespace galactic::bake {

/// Where a pack comes from: goes into the pack, so nothing in it may depend on the machine, the
/// time or the number of threads.
struct Provenance {
  std::string tool = "galactic-bake";
  std::string tool_version;
  /// Long option names and values that decide the content, in a fixed order.
  std::vector<std::pair<std::string, std::string>> options;
  std::vector<SourceFile> sources;
  std::vector<std::string> warnings;
};

}  // namespace galactic::bake
