#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "galactic/error.h"
#include "galactic/pack.h"
#include "galactic/shapes.h"

namespace galactic {

/// One movable rigid body, in its own frame (Y up, meters): views into the pack.
struct ObjectModel {
  std::string_view name;
  /// The shape that stands for the object while it rests.
  OrientedBox box;
  /// The spheres that stand for the object while it is held. By descending radius.
  std::span<const SetSphere> spheres;
  /// Most likely first, at least one.
  std::span<const StablePose> stable_poses;
  /// Planes around the object's convex hull, which cut off corners and edges of the box. Empty if
  /// the hull fills the box, and in packs that are older than this field.
  std::span<const HullPlane> hull_planes{};
};

/// The objects of an object pack, ready to use.
class ObjectSet {
 public:
  /// The objects in `pack`, which must outlive the result. Fails with kInvalidInput if it is
  /// another kind of pack.
  [[nodiscard]] static Result<ObjectSet> from(const PackFile& pack);
  static Result<ObjectSet> from(const PackFile&& pack) = delete;

  /// The working set of radii, meters, ascending: SetSphere::radius_index is an index into it.
  [[nodiscard]] std::span<const float> radii() const { return radii_; }

  /// By ascending name.
  [[nodiscard]] const std::vector<ObjectModel>& objects() const { return objects_; }

  /// Index of the object of this name.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;

 private:
  ObjectSet() = default;

  std::span<const float> radii_;
  std::vector<ObjectModel> objects_;
};

}  // namespace galactic
