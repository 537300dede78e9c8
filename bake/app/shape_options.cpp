#include <fmt/format.h>

#include <map>

#include "galactic/number_text.h"
#include "option_groups.h"
#include "option_values.h"

namespace galactic::bake {
namespace {

const std::map<std::string, BoxFit>& boxNames() {
  static const std::map<std::string, BoxFit> names{
      {"yaw", BoxFit::kYaw}, {"min", BoxFit::kMinimum}, {"aabb", BoxFit::kAxisAligned}};
  return names;
}

/// Tolerances by name, metres.
struct Profile {
  float eps = 0;
  float tau = 0;
};

/// The default profiles of objects and robots, and two for both.
const std::map<std::string, Profile>& profiles() {
  static const std::map<std::string, Profile> named{{"object", {0.015F, 0.020F}},
                                                    {"robot", {0.020F, 0.040F}},
                                                    {"tight", {0.010F, 0.020F}},
                                                    {"coarse", {0.020F, 0.030F}}};
  return named;
}

}  // namespace

void ShapeOptions::addTo(CLI::App& app, BakeCommand& command) {
  app.add_option("--obb", command.object.box,
                 "Box of an object: yaw keeps it upright, min has the least volume, aabb is "
                 "axis-aligned")
      ->transform(CLI::CheckedTransformer(boxNames()))
      ->option_text("yaw|min|aabb");
  app.add_option("--profile", profile_, "Tolerances of the spheres by name (default: by the kind)")
      ->check(CLI::IsMember({"object", "robot", "tight", "coarse"}))
      ->option_text("object|robot|tight|coarse");
  app.add_option("--eps", eps_, "Every reachable surface point lies this near to a sphere, metres")
      ->type_name("METRES");
  app.add_option("--tau", tau_, "No sphere sticks out further, but for thin parts, metres")
      ->type_name("METRES");
  app.add_option("--max-spheres", command.max_spheres,
                 "Most spheres of an object or robot; 0: as many as the tolerances need")
      ->check(wholeCheck(0, 1000000));
  app.add_flag("--no-support", any_side_,
               "Let an object's spheres reach below the face on which it rests");
}

Result<void> ShapeOptions::understand(BakeCommand& command) const {
  const char* by_kind = command.kind == AssetKind::kRobot ? "robot" : "object";
  const Profile& profile = profiles().at(profile_.empty() ? by_kind : profile_);
  command.object.spheres.eps = profile.eps;
  command.object.spheres.tau = profile.tau;
  if (!eps_.empty()) {
    const auto eps = parsePositive(eps_, "--eps");
    if (!eps) return tl::unexpected(eps.error());
    command.object.spheres.eps = static_cast<float>(*eps);
  }
  if (!tau_.empty()) {
    const auto tau = parsePositive(tau_, "--tau");
    if (!tau) return tl::unexpected(tau.error());
    command.object.spheres.tau = static_cast<float>(*tau);
  }
  command.tolerances_given = !profile_.empty() || !eps_.empty() || !tau_.empty();
  command.object.spheres.max_spheres = command.max_spheres.value_or(0);
  command.object.keep_above_support = !any_side_;
  return {};
}

void ShapeOptions::remember(BakeCommand& command) const {
  const SphereSetOptions& spheres = command.object.spheres;
  if (command.kind == AssetKind::kObject) {
    command.remember("obb", nameOf(boxNames(), command.object.box));
    command.remember("support", any_side_ ? "no" : "yes");
  }
  if (command.kind == AssetKind::kObject || command.tolerances_given) {
    command.remember("eps", fmt::format("{}", spheres.eps));
    command.remember("tau", fmt::format("{}", spheres.tau));
  }
  if (command.kind == AssetKind::kObject || command.max_spheres) {
    command.remember("max-spheres", std::to_string(spheres.max_spheres));
  }
}

}  // namespace galactic::bake
