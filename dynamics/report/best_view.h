#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "drawing/rendering.h"
#include "galactic/batch_renderer.h"
#include "galactic/batch_simulator.h"
#include "galactic/error.h"
#include "galactic/world.h"
#include "galactic/world_models.h"
#include "galactic/world_views.h"

namespace galactic::dynamics {

/// What a picture is about: some of an env's objects, a link of the robot, or both.
struct PictureSubject {
  /// Indices into EnvObjects::objects.
  std::vector<std::size_t> objects = {};
  std::optional<std::uint32_t> link = {};
};

/// An env as it was after a step, to be drawn later.
struct Still {
  /// Index into World::scenes().
  std::uint32_t scene = 0;
  /// The view of the camera that follows the robot, without `posed` and `bodies`.
  RenderView view;
  std::vector<PosedModel> posed;
  std::vector<RigidTransform> bodies;
  /// By object of the env: its index in `posed`; none if it has nothing to show.
  std::vector<std::optional<std::size_t>> places;
};

/// Draws stills from where most of their subject is visible: looks at it from all around, and
/// counts how many of its pixels are not hidden. Uses the software renderer, so that the pictures
/// are the same on every machine.
class BestView {
 public:
  /// `world` must outlive the result. `simulator` is one of the simulators, of one env each, from
  /// which stills are taken. Fails as WorldModels::from, chooseCamera and BatchRenderer::create do.
  [[nodiscard]] static Result<std::unique_ptr<BestView>> create(const World& world,
                                                                const BatchSimulator& simulator);

  /// A still of the simulator's env. Valid while this object lives.
  [[nodiscard]] Still take(const BatchSimulator& simulator);

  /// The same moment without the robot, with an object in a different pose.
  [[nodiscard]] static Still withoutRobot(const Still& still, std::size_t object,
                                          const Pose& world_from_object);

  /// Cameras for two stills that see their subjects from the same side and distance, so that the
  /// pictures can be compared, and from where most of both is visible. They stand where the column
  /// grids are free, and outside of robot and objects. If no such camera sees the subject, uses
  /// those that follow the robots.
  [[nodiscard]] std::array<RenderCamera, 2> camerasFor(const std::array<const Still*, 2>& stills,
                                                       const PictureSubject& subject);

  /// Valid until the next call.
  [[nodiscard]] DrawnImage draw(const Still& still, const RenderCamera& camera);

 private:
  /// The subject alone, and a ball around it.
  struct Cutout {
    std::vector<PosedModel> posed;
    std::vector<AttachedModel> attached;
    Vec3 center;
    float radius = 0;
  };

  BestView(const World& world, WorldModels models) : world_(world), models_(std::move(models)) {}

  [[nodiscard]] Cutout cutOut(const Still& still, const PictureSubject& subject) const;
  /// By camera: the visible share of the subject; 0 where there is no room for a camera.
  [[nodiscard]] std::vector<float> sharesSeen(const Still& still, const Cutout& cutout,
                                              const std::vector<RenderCamera>& cameras);
  [[nodiscard]] bool hasPlaceFor(const Vec3& camera, const Still& still) const;

  const World& world_;
  WorldModels models_;
  std::optional<WorldViews> views_;
  std::optional<ImageBatch> looks_;
  std::optional<ImageBatch> picture_;
  /// By link of the robot: the body that carries it.
  std::vector<std::size_t> body_of_link_;
};

}  // namespace galactic::dynamics
