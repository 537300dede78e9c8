#include "robot_description/hand_spheres.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <string_view>
#include <utility>

#include "galactic/bake/triangle_mesh.h"
#include "robot_description/description_process.h"
#include "robot_description/frames.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kTimeLimit{60};

Result<void> checkSphere(const HandSphere& sphere, const std::string& place) {
  const auto within = [](double v) { return std::abs(v) <= kMaxCoordinate; };
  const auto& c = sphere.center;
  // Comparisons with NaN are false.
  if (within(c[0]) && within(c[1]) && within(c[2]) && within(sphere.radius) && sphere.radius > 0) {
    return {};
  }
  return fail(ErrorCode::kInvalidInput, place,
              fmt::format("a sphere at ({} {} {}) of radius {}: expected a finite center and a "
                          "positive radius, in meters",
                          c[0], c[1], c[2], sphere.radius));
}

Result<HandSpheres> finish(HandSpheres spheres, const fs::path& path, std::string_view element) {
  std::erase_if(spheres.links, [](const LinkSpheres& link) { return link.spheres.empty(); });
  for (LinkSpheres& link : spheres.links) {
    for (HandSphere& sphere : link.spheres) {
      RETURN_IF_ERROR(checkSphere(sphere, fmt::format("{}: link '{}'", path.string(), link.link)));
      sphere.center = transformed(kYUpFromZUp, sphere.center);
    }
  }
  if (spheres.links.empty()) {
    return fail(ErrorCode::kInvalidInput, path.string(),
                fmt::format("no link has a {}; is it the spherized file?", element));
  }
  return spheres;
}

}  // namespace

Result<HandSpheres> readSpherizedRobot(const fs::path& path) {
  ASSIGN_OR_RETURN(const auto model, readDescription(path, {}, kTimeLimit));
  HandSpheres spheres;
  for (const DescribedLink& link : model.links) {
    LinkSpheres& set = spheres.links.emplace_back();
    set.link = link.name;
    std::size_t others = 0;
    for (const DescribedShape& shape : link.collisions) {
      if (shape.geometry != DescribedGeometry::kSphere) {
        ++others;
        continue;
      }
      const Affine& t = shape.link_from_shape;
      set.spheres.push_back({.center = {t[3], t[7], t[11]}, .radius = shape.size[0]});
    }
    if (others == 0) continue;
    spheres.warnings.push_back(
        fmt::format("link '{}': {} collision elements are no spheres: "
                    "left out",
                    link.name, others));
  }
  return finish(std::move(spheres), path, "<sphere> collision element");
}

Result<HandSpheres> readSrdfSpheres(const fs::path& path) {
  ASSIGN_OR_RETURN(auto links, readSrdf(path, kTimeLimit));
  for (LinkSpheres& link : links) {
    if (link.spheres.size() == 1 && link.spheres.front().radius == 0) link.spheres.clear();
  }
  return finish({.links = std::move(links), .warnings = {}}, path,
                "<sphere> in a <link_sphere_approximation>");
}

}  // namespace galactic::bake
