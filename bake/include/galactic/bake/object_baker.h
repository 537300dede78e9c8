#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "galactic/bake/oriented_box.h"
#include "galactic/bake/render_baker.h"
#include "galactic/bake/source_asset.h"
#include "galactic/bake/sphere_set.h"
#include "galactic/bake/triangle_mesh.h"
#include "galactic/error.h"
#include "galactic/shapes.h"

namespace galactic::bake {

/// A shape that is given instead of fitted, in the frame of the pack; meters.
struct AuthoredShape {
  /// Taken as it is, along the axes of the frame.
  Bounds box;
  /// In the order of packs: by descending radius, then ascending x, y, z. None: spheres are fitted.
  std::vector<SetSphere> spheres;

  friend bool operator==(const AuthoredShape&, const AuthoredShape&) = default;
};

struct ObjectBakeOptions {
  BoxFit box = BoxFit::kYaw;
  /// Working set, tolerances and budget. `support` is set by the baker.
  SphereSetOptions spheres{};
  /// Whether no sphere may reach below the object's lowest point, so that dropped objects do not
  /// float.
  bool keep_above_support = true;
  /// Given by hand, or by a published collection.
  std::optional<AuthoredShape> authored;

  friend bool operator==(const ObjectBakeOptions&, const ObjectBakeOptions&) = default;
};

/// How long each stage took, seconds of wall-clock time.
struct ObjectTimes {
  double box = 0;
  double stable_poses = 0;
  double spheres = 0;
  double render = 0;
};

/// One object of a pack.
struct BakedObject {
  std::string name;
  ImportStatistics imported;
  Bounds bounds;
  BoxFitResult box;
  std::vector<StablePose> stable_poses;
  std::vector<HullPlane> hull_planes;
  /// The tolerances that were asked for, meters.
  float eps = 0;
  float tau = 0;
  SphereSet spheres;
  /// Whether the spheres were given, and were only measured.
  bool authored_spheres = false;
  Surface surface;
  /// What is drawn, if it is wanted: one model. Not made by bakeObject().
  std::optional<BakedRenderMeshes> render_meshes;
  ObjectTimes times;
  /// What the user should examine: tolerances that could not be met, a doubtful unit and so on.
  std::vector<std::string> warnings;
};

/// Box, stable poses and spheres of one object. Fails with kInvalidInput or kUnsupported if options
/// or geometry make that impossible; `where` names the option or "mesh", or is empty, since the
/// baker does not know the file. The result does not depend on the number of threads.
[[nodiscard]] Result<BakedObject> bakeObject(const SourceAsset& asset,
                                             const ObjectBakeOptions& options,
                                             unsigned threads = 1);

}  // namespace galactic::bake
