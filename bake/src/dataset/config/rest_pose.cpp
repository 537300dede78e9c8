#include <algorithm>
#include <cmath>
#include <cstddef>

#include "dataset/config/placement.h"
#include "import/affine.h"

namespace galactic::bake {
namespace {

bool hasPosition(const SourceLink& link) {
  return link.parent >= 0 && !link.mimic && positionCount(link.joint_type) == 1;
}

/// Rodrigues' rotation about the unit vector `axis`.
Affine rotationAbout(const std::array<double, 3>& axis, double angle) {
  const auto& [x, y, z] = axis;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const double t = 1 - c;
  return {t * x * x + c,     t * x * y - s * z, t * x * z + s * y, 0,
          t * x * y + s * z, t * y * y + c,     t * y * z - s * x, 0,
          t * x * z - s * y, t * y * z + s * x, t * z * z + c,     0};
}

Affine motionOf(const SourceLink& link, double position) {
  switch (link.joint_type) {
    case JointType::kRevolute:
    case JointType::kContinuous:
      return position == 0 ? kIdentityAffine : rotationAbout(link.axis, position);
    case JointType::kPrismatic:
      return translationBy(
          {link.axis[0] * position, link.axis[1] * position, link.axis[2] * position});
    case JointType::kFixed:
    case JointType::kPlanar:
    case JointType::kFloating:
      break;
  }
  return kIdentityAffine;
}

/// Links whose joints have a position of their own, in the order in which a scene lists them.
std::vector<std::size_t> listedJoints(const SourceRobot& furniture) {
  std::vector<std::vector<std::size_t>> children(furniture.links.size());
  for (std::size_t n = 1; n < furniture.links.size(); ++n) {
    children[static_cast<std::size_t>(furniture.links[n].parent)].push_back(n);
  }
  std::vector<std::size_t> listed;
  std::vector<std::size_t> open{0};
  while (!open.empty()) {
    const std::size_t link = open.back();
    open.pop_back();
    if (hasPosition(furniture.links[link])) listed.push_back(link);
    auto& next = children[link];
    // Last first: the stack turns them round.
    std::sort(next.begin(), next.end(), [&](std::size_t a, std::size_t b) {
      return furniture.links[a].joint_name > furniture.links[b].joint_name;
    });
    open.insert(open.end(), next.begin(), next.end());
  }
  return listed;
}

void applyPositions(const SourceRobot& furniture,
                    const std::vector<std::pair<std::string, double>>& stated,
                    std::vector<double>& positions) {
  const std::vector<std::size_t> joints = listedJoints(furniture);
  const auto joint_named = [&](const std::string& name) {
    return std::find_if(joints.begin(), joints.end(),
                        [&](std::size_t link) { return furniture.links[link].joint_name == name; });
  };
  const bool by_name = std::all_of(stated.begin(), stated.end(), [&](const auto& one) {
    return joint_named(one.first) != joints.end();
  });
  for (std::size_t n = 0; n < stated.size(); ++n) {
    if (by_name) {
      positions[*joint_named(stated[n].first)] = stated[n].second;
    } else if (n < joints.size()) {
      positions[joints[n]] = stated[n].second;
    }
  }
}

}  // namespace

std::vector<Affine> restPose(const SourceRobot& furniture,
                             const std::vector<std::pair<std::string, double>>& positions) {
  const std::vector<SourceLink>& links = furniture.links;
  std::vector<double> position(links.size(), 0);
  if (!links.empty()) applyPositions(furniture, positions, position);
  for (std::size_t n = 0; n < links.size(); ++n) {
    if (!links[n].limits || !hasPosition(links[n])) continue;
    position[n] = std::clamp(position[n], links[n].limits->lower, links[n].limits->upper);
  }
  std::vector<Affine> root_from_link(links.size(), kIdentityAffine);
  for (std::size_t n = 0; n < links.size(); ++n) {
    const SourceLink& link = links[n];
    if (link.parent < 0) continue;
    double value = position[n];
    if (link.mimic)
      value = link.mimic->multiplier * position[link.mimic->link] + link.mimic->offset;
    const Affine parent_from_link = compose(link.parent_from_joint, motionOf(link, value));
    root_from_link[n] =
        compose(root_from_link[static_cast<std::size_t>(link.parent)], parent_from_link);
  }
  return root_from_link;
}

}  // namespace galactic::bake
