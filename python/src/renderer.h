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

/// The options of a Renderer.
struct CameraOptions {
  RenderOptions render;
  CameraWish camera;
  ViewContent content;
};

/// galactic.Renderer: the cameras of a simulator's envs, and the renderer that draws what they see.
/// Only one thread may use it at a time. Every member needs the interpreter's lock; those that take
/// long release it while they work.
class Renderer {
 public:
  /// Throws the errors of chooseCamera, WorldModels::from and BatchRenderer::create as an
  /// ErrorException, and one if the simulator was made without body_transforms.
  [[nodiscard]] static std::unique_ptr<Renderer> create(const py::object& simulator,
                                                        const CameraOptions& options);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;
  Renderer(Renderer&&) = delete;
  Renderer& operator=(Renderer&&) = delete;

  /// Draws the envs with the numbers `envs`, or all for None, into the arrays in the dictionary
  /// `out`, or into new ones if it lacks them. Returns all arrays by name.
  py::dict render(const py::object& out, const py::object& envs);
  /// The same in two halves; the simulator may step in between.
  void beginRender(const py::object& out, const py::object& envs);
  py::dict endRender();
  /// Moves a camera that stands in the world, from the next drawing on. Throws an ErrorException
  /// for invalid places and for cameras on the robot.
  void placeCamera(const std::vector<RigidTransform>& world_from_camera);
  /// Draws all envs into the memory of a CUDA device; returns arrays for DLPack, by name.
  py::dict renderToDevice(std::uintptr_t stream);

  [[nodiscard]] const BatchRenderer& batch() const { return *renderer_; }
  /// The names that the numbers in semantic images stand for.
  [[nodiscard]] py::tuple semanticNames() const;
  /// int32: the scene of each of these names, an index into World.scenes, or -1.
  [[nodiscard]] py::array_t<std::int32_t> semanticScenes() const;
  /// float32 (3, 3): maps directions in the frames of worldFromCameras() to pixels. (envs, 3, 3) if
  /// fields of view differ, as of the last drawing.
  [[nodiscard]] py::array_t<float> intrinsics();
  /// float32 (envs, 4, 4): the poses of the cameras in the last drawing, with the axes of images: X
  /// to the right, Y down, Z ahead.
  [[nodiscard]] py::array_t<float> worldFromCameras();
  /// By name, float32 (envs,): the noise that the episodes had drawn, as of the last drawing.
  [[nodiscard]] py::dict episodeNoise();
  /// Shape and type of the images of one env, by name.
  [[nodiscard]] py::dict shapes() const;

 private:
  Renderer(const py::object& simulator, WorldModels models);

  /// Copies the simulator's state, and returns the views of the requested envs.
  std::span<const RenderView> viewsOf(const py::object& envs);
  /// The memory for `count` images: arrays from `out`, or else new ones. Remembers them in images_.
  [[nodiscard]] RenderTargets targetsFor(std::size_t count, const py::object& out);
  void requireIdle() const;

  py::object simulator_;
  Confinement confinement_{"Renderer"};
  WorldModels models_;
  std::optional<WorldViews> views_;
  /// What the camera moves with; empty if it stands in the world.
  std::string mount_;
  /// Whether fields of view differ between envs.
  bool has_fovs_ = false;
  std::vector<RenderView> chosen_;
  /// Arrays by name, kept at least until the current rendering is done.
  py::dict images_;
  bool is_rendering_ = false;
  std::optional<BatchRenderer> renderer_;
};

}  // namespace galactic::python
