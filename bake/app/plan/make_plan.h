#pragma once
#include "galactic/error.h"
#include "options.h"
#include "plan/plan.h"

namespace galactic::bake {

/// What the command's dataset or recipe is made of. Reads the recipe and the datasets' lists, no
/// mesh. Fails with kInvalidInput where two packs would have one name, or a scene lacks something
/// and the command wants that to be an error.
[[nodiscard]] Result<WorldPlan> makePlan(const BakeCommand& command);

/// The names of the scenes that the command wants of its dataset, ascending.
[[nodiscard]] Result<std::vector<std::string>> namesOfScenes(const BakeCommand& command);

}  // namespace galactic::bake
