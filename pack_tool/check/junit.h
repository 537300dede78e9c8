#pragma once
#include <string>
#include <vector>

#include "pack_tool/check/pack_checker.h"

namespace galactic::pack_tool {

/// The results as a JUnit report (XML), which CI systems read: one test case for each pack in the
/// order of `packs`, the packs of a world before it. A bad pack has a failure with the code as its
/// type. No times and no host: the same packs give the same bytes.
[[nodiscard]] std::string junitText(const std::vector<CheckedPack>& packs);

}  // namespace galactic::pack_tool
