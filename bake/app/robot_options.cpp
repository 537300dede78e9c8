#include <fmt/format.h>

#include "option_groups.h"

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
    const std::size_t equals = package.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == package.size()) {
      return fail(ErrorCode::kInvalidInput, "--package",
                  fmt::format("is \"{}\", NAME=DIR is wanted", package));
    }
    const auto [place, fresh] =
        command.robot.packages.emplace(package.substr(0, equals), package.substr(equals + 1));
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
