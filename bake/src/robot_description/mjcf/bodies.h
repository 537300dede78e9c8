#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "robot_description/description.h"
#include "robot_description/mjcf/assets.h"
#include "robot_description/mjcf/attributes.h"
#include "robot_description/mjcf/geoms.h"

namespace galactic::bake {

enum class MjcfJointType { kHinge, kSlide, kBall, kFree };

/// How a body moves against its parent: about or along an axis in the body's frame.
struct MjcfJoint {
  std::string name;
  MjcfJointType type = MjcfJointType::kHinge;
  /// Where the axis of a hinge goes through, in the body's frame.
  std::array<double, 3> anchor{};
  std::array<double, 3> axis{0, 0, 1};
  /// The position at which the body is where the text places it; radians or meters.
  double reference = 0;
  bool is_limited = false;
  double lower = 0;
  double upper = 0;
};

/// A camera that stays where it is on its body.
struct MjcfCamera {
  std::string name;
  /// A frame whose X looks along the view and whose Z is up in the image.
  Affine body_from_view{};
};

struct MjcfBody {
  std::string name;
  /// Where it stands, for messages.
  std::string place;
  /// Index of the body that it is in; -1: the world.
  int parent = -1;
  /// Where the text places it.
  Affine parent_from_body{};
  /// In the order in which they move the body, each within what those before have moved.
  std::vector<MjcfJoint> joints;
  std::vector<MjcfGeom> geoms;
  /// Those that have a name.
  std::vector<MjcfCamera> cameras;
  std::optional<LinkInertial> inertial;
};

/// What is in the <worldbody> of an MJCF.
struct MjcfWorld {
  /// In the order of the text, so parents before children; without those that others move (mocap).
  std::vector<MjcfBody> bodies;
  /// How many shapes belong to no body.
  std::size_t loose_geoms = 0;
};

/// Reads every <worldbody> of `root`. Bodies and joints without a name get one. `part`: whether
/// <inertial> elements are read.
[[nodiscard]] MjcfWorld readBodies(const XmlElement& root, const MjcfDefaults& defaults,
                                   const MjcfSettings& settings, const MjcfAssets& assets,
                                   DescriptionPart part);

}  // namespace galactic::bake
