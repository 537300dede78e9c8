#include <fmt/format.h>

#include <utility>

#include "option_groups.h"
#include "option_values.h"

namespace galactic::bake {

void RobotFileOptions::addTo(CLI::App& app, BakeCommand& command) {
  app.add_option("--recipe", command.robot.recipe,
                 "Robot recipe (TOML, see --print-recipe) or published *.collection.json")
      ->type_name("FILE");
  app.add_option("--spheres", command.robot.spheres,
                 "Hand-made spheres: a spherized URDF or an SRDF; they replace the fitted ones")
      ->type_name("FILE");
  app.add_option("--package", packages_, "Folder of a ROS package (may be repeated): NAME=DIR")
      ->type_name("NAME=DIR")
      ->allow_extra_args(false);
  app.add_flag("--allow-missing", command.robot.allow_missing,
               "Links that lost all their geometry are warnings, not errors");
}

Result<void> RobotFileOptions::understand(BakeCommand& command) const {
  for (const std::string& package : packages_) {
    auto pair = parsePair(package, "--package", "NAME=DIR");
    if (!pair) return tl::unexpected(pair.error());
    const auto [place, fresh] = command.robot.packages.insert(std::move(*pair));
    if (!fresh) {
      return fail(ErrorCode::kInvalidInput, "--package",
                  fmt::format("names {} twice; give each package once", place->first));
    }
  }
  return {};
}

void RobotFileOptions::remember(BakeCommand& command) const {
  if (command.robot.allow_missing) command.remember("allow-missing", "yes");
}

}  // namespace galactic::bake
