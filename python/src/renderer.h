#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "confinement.h"
#include "galactic/batch_renderer.h"
#include "galactic/world_models.h"
#include "galactic/world_views.h"
#include "simulator.h"

namespace galactic::python {

/// What Renderer is made with, besides its simulator.
struct CameraOptions {
  RenderOptions render;
  CameraWish camera;
  ViewContent content;
};

/// galactic.Renderer: the cameras of a simulator's envs, and the renderer that draws what they see.
/// Used by one thread at a time. Every member needs the interpreter's lock; the long ones give it
/// away while they work.
class Renderer {
 public:
  /// Throws the errors of chooseCamera, WorldModels::from and BatchRenderer::create as an
  /// ErrorException, and one when the simulator was made without body_transforms.
  [[nodiscard]] static std::unique_ptr<Renderer> create(const py::object& simulator,
                                                        const CameraOptions& options);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;
  Renderer(Renderer&&) = delete;
  Renderer& operator=(Renderer&&) = delete;

  /// Draws the envs of the numbers `envs`, or all of them for None, into the arrays of the
  /// dictionary `out`, or into new ones for what it does not have. Returns all of them by name.
  py::dict render(const py::object& out, const py::object& envs);
  /// The same in two halves: the simulator may step meanwhile.
  void beginRender(const py::object& out, const py::object& envs);
  py::dict endRender();
  /// Has the camera, which is none on the robot, stand elsewhere when it draws next. Throws an
  /// ErrorException for places that are none.
  void placeCamera(const std::vector<RigidTransform>& world_from_camera);
  /// Draws all envs into the memory of a CUDA device: arrays for DLPack, by name.
  py::dict renderToDevice(std::uintptr_t stream);

  [[nodiscard]] const BatchRenderer& batch() const { return *renderer_; }
  /// What the numbers of semantic images mean.
  [[nodiscard]] py::tuple semanticNames() const;
  /// int32, for each of them: the scene that it is of, an index into World.scenes, or -1.
  [[nodiscard]] py::array_t<std::int32_t> semanticScenes() const;
  /// float32 (3, 3): from directions in the frames of worldFromCameras() to pixels. Where fields of
  /// view differ, (envs, 3, 3), as when images were drawn last.
  [[nodiscard]] py::array_t<float> intrinsics();
  /// float32 (envs, 4, 4): where the cameras were when images were drawn last, with the axes of
  /// images: X to the right, Y down, Z ahead.
  [[nodiscard]] py::array_t<float> worldFromCameras();
  /// By name, float32 (envs,): the noise that the episodes had drawn when images were drawn last.
  [[nodiscard]] py::dict episodeNoise();
  /// Of the images of one env, by name: shape and type.
  [[nodiscard]] py::dict shapes() const;

 private:
  Renderer(const py::object& simulator, WorldModels models);

  /// Copies the simulator's state, and returns the views of the envs that are asked for.
  std::span<const RenderView> viewsOf(const py::object& envs);
  /// Where `count` images go, of what `out` has and of new arrays, which become images_.
  [[nodiscard]] RenderTargets targetsFor(std::size_t count, const py::object& out);
  void requireIdle() const;

  py::object simulator_;
  Confinement confinement_{"Renderer"};
  WorldModels models_;
  std::optional<WorldViews> views_;
  /// What it moves with; empty where it stands in the world.
  std::string mount_;
  /// Whether fields of view differ.
  bool has_fovs_ = false;
  std::vector<RenderView> chosen_;
  /// Arrays by name; those of a rendering under way stay until it is done.
  py::dict images_;
  bool is_rendering_ = false;
  std::optional<BatchRenderer> renderer_;
};

}  // namespace galactic::python
