#pragma once
#include <fmt/format.h>

#include <string>
#include <string_view>

namespace galactic::test {

/// A recipe of a world that bakes quickly from the sample's sources: two radii, the objects whose
/// names begin with m, a coarse porter, two objects in an episode. `scenes` holds the lines that
/// name the scenes, `episodes` those about episodes besides.
inline std::string quickRecipe(std::string_view scenes, std::string_view episodes) {
  return fmt::format(R"([bake]
radii = [0.05, 0.12]
[[scenes]]
{}
check-columns = 0
[[objects]]
files = "objects/m*.glb"
eps = 0.03
tau = 0.06
[robot]
files = "robot/porter.urdf"
recipe = "robot/robot.toml"
eps = 0.06
tau = 0.08
max-spheres = 30
[episodes]
objects = 2
{}
)",
                     scenes, episodes);
}

}  // namespace galactic::test
