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

/// How a body moves relative to its parent: about or along an axis in the body's frame.
struct MjcfJoint {
  std::string name;
  MjcfJointType type = MjcfJointType::kHinge;
  /// A point on the axis of a hinge, in the body's frame.
  std::array<double, 3> anchor{};
  std::array<double, 3> axis{0, 0, 1};
  /// The position at which the body has its pose from the text; radians or meters.
  double reference = 0;
  bool is_limited = false;
  double lower = 0;
  double upper = 0;
};

/// A camera that is fixed to its body.
struct MjcfCamera {
  std::string name;
  /// In the view frame, X points along the view and Z is up in the image.
  Affine body_from_view{};
};

struct MjcfBody {
  std::string name;
  /// Its place in the text, for messages.
  std::string place;
  /// Index of the parent body; -1 for the world.
  int parent = -1;
  /// Its pose in the text.
  Affine parent_from_body{};
  /// In the order in which they move the body; each moves within the frame that those before it
  /// have moved.
  std::vector<MjcfJoint> joints;
  std::vector<MjcfGeom> geoms;
  /// Only those that have a name.
  std::vector<MjcfCamera> cameras;
  std::optional<LinkInertial> inertial;
};

/// The content of the <worldbody> of an MJCF.
struct MjcfWorld {
  /// In the order of the text, so that parents precede children; without bodies that others move
  /// (mocap).
  std::vector<MjcfBody> bodies;
  /// Number of shapes that belong to no body.
  std::size_t loose_geoms = 0;
};

/// Reads every <worldbody> of `root`. Gives names to bodies and joints that have none. `part`
/// determines whether to read <inertial> elements.
[[nodiscard]] MjcfWorld readBodies(const XmlElement& root, const MjcfDefaults& defaults,
                                   const MjcfSettings& settings, const MjcfAssets& assets,
                                   DescriptionPart part);

}  // namespace galactic::bake
