#include "renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "arrays.h"
#include "bindings.h"
#include "dlpack.h"
#include "filled.h"
#include "galactic/error.h"

namespace galactic::python {
namespace {

const char* colorName(ColorFormat format) { return format == ColorFormat::kRgba8 ? "rgba" : "rgb"; }

Shape imageShape(std::size_t count, const RenderOptions& options) {
  return {static_cast<py::ssize_t>(count), static_cast<py::ssize_t>(options.height),
          static_cast<py::ssize_t>(options.width)};
}

Shape colorShape(std::size_t count, const RenderOptions& options) {
  Shape shape = imageShape(count, options);
  shape.push_back(static_cast<py::ssize_t>(options.color));
  return shape;
}

/// The caller's array of that name, or a new one; added to `images`.
template <class T>
std::span<T> targetOf(const py::dict& out, const char* name, const Shape& shape, py::dict& images) {
  const py::object array =
      out.contains(name) ? py::object(out[name]) : py::object(py::array_t<T>(shape));
  images[name] = array;
  return outputOf<T>(array, name, shape);
}

/// Empty for cameras on the robot.
void requirePlaces(std::size_t found, std::size_t envs) {
  if (found <= 1 || found == envs) return;
  throw ErrorException{{ErrorCode::kInvalidInput, "world_from_camera",
                        fmt::format("has {} matrices, expected one for all envs, or one for each "
                                    "of {}",
                                    found, envs)}};
}

}  // namespace

Renderer::Renderer(const py::object& simulator, WorldModels models)
    : simulator_(simulator), models_(std::move(models)) {}

Renderer::~Renderer() {
  if (!is_rendering_) return;
  // A rendering may still be writing to the images, so wait for it; its errors no longer matter.
  try {
    renderer_->endRender();
  } catch (const std::exception&) {
  }
}

std::unique_ptr<Renderer> Renderer::create(const py::object& simulator,
                                           const CameraOptions& options) {
  auto& shown = simulator.cast<Simulator&>();
  if (!shown.batch().options().body_transforms) {
    throw ErrorException{{ErrorCode::kInvalidInput, "simulator",
                          "was made without body_transforms, which drawing needs; make it with "
                          "body_transforms=True"}};
  }
  const ChosenCamera camera = orThrow(chooseCamera(shown.world().robot(), options.camera));
  requirePlaces(camera.mount.world_from_camera.size(), shown.batch().envCount());
  std::unique_ptr<Renderer> renderer(
      new Renderer(simulator, orThrow(WorldModels::from(shown.world()))));
  RenderOptions render = options.render;
  render.near = camera.near;
  renderer->mount_ = options.camera.name;
  renderer->has_fovs_ = camera.mount.jitter.camera_jitter_fov.most > 0;
  const Confinement::Use use = shown.readState();
  const py::gil_scoped_release unlocked;
  renderer->renderer_.emplace(orThrow(BatchRenderer::create(renderer->models_.library(), render)));
  renderer->views_.emplace(renderer->models_, shown.batch(), camera.mount, options.content);
  return renderer;
}

void Renderer::requireIdle() const {
  if (is_rendering_) throw std::runtime_error("a rendering is under way; call end_render() first");
}

std::span<const RenderView> Renderer::viewsOf(const py::object& envs) {
  auto& simulator = simulator_.cast<Simulator&>();
  const std::vector<std::uint32_t> numbers =
      envs.is_none() ? std::vector<std::uint32_t>() : simulator.envNumbers(envs);
  const Confinement::Use use = simulator.readState();
  views_->update(simulator.batch());
  if (envs.is_none()) return views_->views();
  chosen_.clear();
  for (const std::uint32_t env : numbers) chosen_.push_back(views_->views()[env]);
  return chosen_;
}

RenderTargets Renderer::targetsFor(std::size_t count, const py::object& out) {
  if (!out.is_none() && !py::hasattr(out, "keys")) {
    throw py::type_error(
        fmt::format("out is a {}, expected a dictionary of arrays by name", typeName(out)));
  }
  const py::dict given = out.is_none() ? py::dict() : py::dict(out);
  const RenderOptions& options = renderer_->options();
  py::dict images;
  RenderTargets targets;
  if (options.color != ColorFormat::kNone) {
    targets.color =
        targetOf<std::uint8_t>(given, colorName(options.color), colorShape(count, options), images);
  }
  if (options.depth) {
    targets.depth = targetOf<float>(given, "depth", imageShape(count, options), images);
  }
  if (options.semantics) {
    // Signed, because torch before 2.3 has no unsigned 32-bit integers.
    const auto ids = targetOf<std::int32_t>(given, "semantics", imageShape(count, options), images);
    targets.semantics = {reinterpret_cast<std::uint32_t*>(ids.data()), ids.size()};
  }
  for (const auto& [name, array] : given) {
    if (images.contains(name)) continue;
    throw py::value_error(fmt::format("out has {}, which this renderer does not draw",
                                      py::repr(name).cast<std::string>()));
  }
  images_ = images;
  return targets;
}

py::dict Renderer::render(const py::object& out, const py::object& envs) {
  const Confinement::Use use = confinement_.enter();
  requireIdle();
  const std::span<const RenderView> views = viewsOf(envs);
  const RenderTargets targets = targetsFor(views.size(), out);
  {
    const py::gil_scoped_release unlocked;
    renderer_->render(views, targets);
  }
  return std::exchange(images_, py::dict());
}

void Renderer::beginRender(const py::object& out, const py::object& envs) {
  const Confinement::Use use = confinement_.enter();
  requireIdle();
  const std::span<const RenderView> views = viewsOf(envs);
  const RenderTargets targets = targetsFor(views.size(), out);
  const py::gil_scoped_release unlocked;
  renderer_->beginRender(views, targets);
  is_rendering_ = true;
}

py::dict Renderer::endRender() {
  const Confinement::Use use = confinement_.enter();
  if (!is_rendering_) {
    throw std::runtime_error("no rendering is under way; call begin_render() first");
  }
  is_rendering_ = false;
  py::dict images = std::exchange(images_, py::dict());
  const py::gil_scoped_release unlocked;
  renderer_->endRender();
  return images;
}

void Renderer::placeCamera(const std::vector<RigidTransform>& world_from_camera) {
  const Confinement::Use use = confinement_.enter();
  if (!mount_.empty()) {
    throw ErrorException{{ErrorCode::kInvalidInput, "place_camera",
                          fmt::format("found the camera {}, which moves with the robot; make the "
                                      "Renderer with world_from_camera",
                                      mount_)}};
  }
  requirePlaces(world_from_camera.size(), views_->views().size());
  orThrow(checkPlaces("world_from_camera", world_from_camera));
  views_->placeCamera(world_from_camera);
}

py::dict Renderer::renderToDevice(std::uintptr_t stream) {
  const Confinement::Use use = confinement_.enter();
  requireIdle();
  const std::span<const RenderView> views = viewsOf(py::none());
  const DeviceImages images = [&] {
    const py::gil_scoped_release unlocked;
    return orThrow(renderer_->renderToDevice(views, stream));
  }();
  const RenderOptions& options = renderer_->options();
  const py::object self = py::cast(this);
  py::dict arrays;
  const auto add = [&](const char* name, std::uint64_t address, const Shape& shape,
                       ElementType type) {
    if (address == 0) return;
    arrays[name] = py::cast(DeviceArray({address, images.device}, shape, type, self));
  };
  add(colorName(options.color), images.color, colorShape(views.size(), options),
      ElementType::kUint8);
  add("depth", images.depth, imageShape(views.size(), options), ElementType::kFloat32);
  add("semantics", images.semantics, imageShape(views.size(), options), ElementType::kInt32);
  return arrays;
}

py::tuple Renderer::semanticNames() const {
  py::list names;
  for (const auto& name : models_.library().semanticNames()) names.append(fileText(name));
  return py::tuple(names);
}

py::array_t<std::int32_t> Renderer::semanticScenes() const {
  const RenderLibrary& library = models_.library();
  std::vector<std::int32_t> scenes(library.semanticNames().size(), -1);
  const std::size_t count = simulator_.cast<Simulator&>().world().scenes().size();
  for (std::uint32_t scene = 0; scene < count; ++scene) {
    const std::optional<std::uint32_t> model = models_.sceneModel(scene);
    if (!model) continue;
    const std::size_t pack = library.entry(*model).pack;
    const std::size_t names = library.packs()[pack].semantics.size();
    std::ranges::fill(std::span(scenes).subspan(library.firstSemantic(pack), names),
                      static_cast<std::int32_t>(scene));
  }
  return py::array_t<std::int32_t>(static_cast<py::ssize_t>(scenes.size()), scenes.data());
}

py::array_t<float> Renderer::intrinsics() {
  const Confinement::Use use = confinement_.enter();
  const RenderOptions& options = renderer_->options();
  const std::span<const RenderView> views =
      views_->views().first(has_fovs_ ? views_->views().size() : 1);
  Shape shape{3, 3};
  if (has_fovs_) shape.insert(shape.begin(), static_cast<py::ssize_t>(views.size()));
  Filled<float> matrices(shape);
  for (const RenderView& view : views) {
    matrices.put(cameraMatrix(view.camera, options.width, options.height));
  }
  return matrices.array();
}

py::array_t<float> Renderer::worldFromCameras() {
  const Confinement::Use use = confinement_.enter();
  const std::span<const RenderView> views = views_->views();
  py::array_t<float> matrices(
      {static_cast<py::ssize_t>(views.size()), py::ssize_t{4}, py::ssize_t{4}});
  float* to = matrices.mutable_data();
  for (const RenderView& view : views) {
    writeMatrix(worldFromImageAxes(view.camera), to);
    to += 16;
  }
  return matrices;
}

py::dict Renderer::episodeNoise() {
  const Confinement::Use use = confinement_.enter();
  const std::span<const RenderView> views = views_->views();
  const Shape each{static_cast<py::ssize_t>(views.size())};
  Filled<float> depth(each), dropout(each), color(each), light(each);
  for (const RenderView& view : views) {
    const ImageNoise noise = episodeImageNoise(renderer_->options().noise, view.noise);
    depth.put(noise.depth_noise.most);
    dropout.put(noise.depth_dropout.most);
    color.put(noise.color_noise.most);
    light.put(noise.light_jitter.most);
  }
  using namespace py::literals;
  return py::dict("depth_noise"_a = depth.array(), "depth_dropout"_a = dropout.array(),
                  "color_noise"_a = color.array(), "light_jitter"_a = light.array());
}

py::dict Renderer::shapes() const {
  const RenderOptions& options = renderer_->options();
  const auto height = static_cast<py::ssize_t>(options.height);
  const auto width = static_cast<py::ssize_t>(options.width);
  py::dict shapes;
  if (options.color != ColorFormat::kNone) {
    shapes[colorName(options.color)] =
        py::make_tuple(py::make_tuple(height, width, static_cast<int>(options.color)),
                       py::dtype::of<std::uint8_t>());
  }
  if (options.depth) {
    shapes["depth"] = py::make_tuple(py::make_tuple(height, width), py::dtype::of<float>());
  }
  if (options.semantics) {
    shapes["semantics"] =
        py::make_tuple(py::make_tuple(height, width), py::dtype::of<std::int32_t>());
  }
  return shapes;
}

}  // namespace galactic::python
