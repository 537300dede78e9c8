#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "arrays.h"
#include "bindings.h"
#include "dlpack.h"
#include "galactic/batch_renderer.h"
#include "galactic/error.h"
#include "options.h"
#include "renderer.h"

namespace galactic::python {
namespace {

ColorFormat colorOf(const py::handle& value) {
  if (value.is_none()) return ColorFormat::kNone;
  const std::string name = wordOf("color", value, "rgb, rgba or None");
  if (name == "rgb") return ColorFormat::kRgb8;
  if (name == "rgba") return ColorFormat::kRgba8;
  throw ErrorException{
      {ErrorCode::kInvalidInput, "color", "is " + name + ", expected rgb, rgba or None"}};
}

RenderBackend backendOf(const py::handle& value) {
  std::string wanted;
  for (const NamedBackend& one : kRenderBackends) {
    const bool is_last = &one == &kRenderBackends.back();
    wanted += fmt::format("{}{}", wanted.empty() ? "" : is_last ? " or " : ", ", one.name);
  }
  const std::string name = wordOf("backend", value, wanted.c_str());
  const auto* found = std::ranges::find(kRenderBackends, name, &NamedBackend::name);
  if (found != kRenderBackends.end()) return found->backend;
  throw ErrorException{
      {ErrorCode::kInvalidInput, "backend", fmt::format("is {}, expected {}", name, wanted)}};
}

/// A device by its name, or by its index as a number.
std::string deviceOf(const py::handle& value) {
  if (PyIndex_Check(value.ptr()) == 0) return wordOf("device", value, "an index or a name");
  return std::to_string(wholeOf("device", value, 0, std::numeric_limits<std::uint16_t>::max()));
}

std::uint32_t edgeOf(const char* name, const py::handle& value) {
  return static_cast<std::uint32_t>(wholeOf(name, value, 1, kLargestImage));
}

/// The place of a camera, from a row-major homogeneous matrix with the axes of images.
RigidTransform placeOf(const float* rows) {
  constexpr std::array<float, 4> kLastRow{0, 0, 0, 1};
  const std::span last(rows + 12, kLastRow.size());
  if (!std::ranges::equal(last, kLastRow)) {
    throw ErrorException{
        {ErrorCode::kInvalidInput, "world_from_camera",
         fmt::format("has the last row ({}), expected (0, 0, 0, 1)", fmt::join(last, ", "))}};
  }
  const auto column = [&](std::size_t n) { return Vec3{rows[n], rows[4 + n], rows[8 + n]}; };
  return worldFromCameraAxes({column(0), column(1), column(2), column(3)});
}

/// The places of cameras, from a matrix (4, 4) or several, (n, 4, 4).
std::vector<RigidTransform> placesOf(const py::handle& value) {
  constexpr const char* kName = "world_from_camera";
  const py::array given = numbersIn(value, kName);
  const py::ssize_t axes = given.ndim();
  const bool is_matrix = axes == 2 || (axes == 3 && given.shape(0) > 0);
  if (!is_matrix || given.shape(axes - 1) != 4 || given.shape(axes - 2) != 4) {
    const std::span shape(given.shape(), static_cast<std::size_t>(axes));
    throw py::value_error(fmt::format("{} has the shape {}, expected (4, 4) or (num_envs, 4, 4)",
                                      kName, shapeText(shape)));
  }
  const auto matrices =
      inputOf<float>(given, kName, Shape(given.shape(), given.shape() + given.ndim()));
  std::vector<RigidTransform> places;
  for (const float* rows = matrices.data(); rows != matrices.data() + matrices.size(); rows += 16) {
    places.push_back(placeOf(rows));
  }
  return places;
}

/// Points of the shape (3,) or (n, 3).
std::vector<Vec3> someOrOnePoint(py::array given, const char* name) {
  if (given.ndim() == 1 && given.shape(0) == 3) given = given.reshape({1, 3});
  return pointsOf(given, name);
}

/// lookAt(), with errors under the name that it has in Python.
RigidTransform cameraLooking(const Vec3& eye, const Vec3& target) try {
  return lookAt(eye, target);
} catch (const ErrorException& refused) {
  throw ErrorException{{refused.error().code, "look_at", refused.error().message}};
}

/// Python's look_at().
py::array_t<float> matricesOfLooks(const py::object& eye, const py::object& target) {
  const py::array given_eye = numbersIn(eye, "eye");
  const py::array given_target = numbersIn(target, "target");
  const std::vector<Vec3> eyes = someOrOnePoint(given_eye, "eye");
  const std::vector<Vec3> targets = someOrOnePoint(given_target, "target");
  if (eyes.size() != targets.size() && eyes.size() != 1 && targets.size() != 1) {
    throw py::value_error(fmt::format(
        "found {} points as eye and {} as target, expected as many of both, or one of either",
        eyes.size(), targets.size()));
  }
  const std::size_t count = eyes.size() == 1 ? targets.size() : eyes.size();
  py::array_t<float> matrices({static_cast<py::ssize_t>(count), py::ssize_t{4}, py::ssize_t{4}});
  for (std::size_t n = 0; n < count; ++n) {
    const RigidTransform camera =
        cameraLooking(eyes[eyes.size() == 1 ? 0 : n], targets[targets.size() == 1 ? 0 : n]);
    writeMatrix(worldFromImageAxes({camera}), matrices.mutable_data() + 16 * n);
  }
  const bool is_one = given_eye.ndim() == 1 && given_target.ndim() == 1;
  return is_one ? matrices.reshape({4, 4}) : matrices;
}

py::object nameOf(ColorFormat color) {
  if (color == ColorFormat::kNone) return py::none();
  return py::str(color == ColorFormat::kRgb8 ? "rgb" : "rgba");
}

py::object tupleOf(const std::array<float, 3>& three) {
  return py::make_tuple(three[0], three[1], three[2]);
}

/// A keyword of Renderer: how to set its value, and how to get it.
struct Keyword {
  std::string_view name;
  void (*take)(CameraOptions&, const py::handle&);
  py::object (*value)(const CameraOptions&);
};

constexpr Keyword kKeywords[] = {
    {"width", [](CameraOptions& o, const py::handle& v) { o.render.width = edgeOf("width", v); },
     [](const CameraOptions& o) -> py::object { return py::int_(o.render.width); }},
    {"height", [](CameraOptions& o, const py::handle& v) { o.render.height = edgeOf("height", v); },
     [](const CameraOptions& o) -> py::object { return py::int_(o.render.height); }},
    {"color", [](CameraOptions& o, const py::handle& v) { o.render.color = colorOf(v); },
     [](const CameraOptions& o) { return nameOf(o.render.color); }},
    {"depth", [](CameraOptions& o, const py::handle& v) { o.render.depth = truthOf("depth", v); },
     [](const CameraOptions& o) -> py::object { return py::bool_(o.render.depth); }},
    {"semantics",
     [](CameraOptions& o, const py::handle& v) {
       const bool of_objects = py::isinstance<py::str>(v) && v.cast<std::string>() == "objects";
       o.content.ids = of_objects ? ObjectIds::kObjects : ObjectIds::kNames;
       o.render.semantics = of_objects || truthOf("semantics", v, "True, False or objects");
     },
     [](const CameraOptions& o) -> py::object {
       if (o.render.semantics && o.content.ids == ObjectIds::kObjects) return py::str("objects");
       return py::bool_(o.render.semantics);
     }},
    {"camera",
     [](CameraOptions& o, const py::handle& v) {
       o.camera.name = wordOf("camera", v, "head, follow, top or a link");
     },
     [](const CameraOptions& o) -> py::object { return py::str(o.camera.name); }},
    {"world_from_camera",
     [](CameraOptions& o, const py::handle& v) {
       o.camera.world_from_camera = v.is_none() ? std::vector<RigidTransform>() : placesOf(v);
     },
     [](const CameraOptions&) -> py::object { return py::none(); }},
    {"fov_degrees",
     [](CameraOptions& o, const py::handle& v) {
       o.camera.fov_degrees = static_cast<float>(numberOf("fov_degrees", v));
     },
     [](const CameraOptions& o) -> py::object { return py::float_(o.camera.fov_degrees); }},
    {"position",
     [](CameraOptions& o, const py::handle& v) {
       std::ranges::copy(finiteNumbers(v, "position", 3), o.camera.position.begin());
     },
     [](const CameraOptions& o) { return tupleOf(o.camera.position); }},
    {"rpy_degrees",
     [](CameraOptions& o, const py::handle& v) {
       std::ranges::copy(finiteNumbers(v, "rpy_degrees", 3), o.camera.rpy_degrees.begin());
     },
     [](const CameraOptions& o) { return tupleOf(o.camera.rpy_degrees); }},
    {"near",
     [](CameraOptions& o, const py::handle& v) {
       o.camera.near = static_cast<float>(numberOf("near", v));
     },
     [](const CameraOptions& o) -> py::object { return py::float_(o.camera.near); }},
    {"robot", [](CameraOptions& o, const py::handle& v) { o.content.robot = truthOf("robot", v); },
     [](const CameraOptions& o) -> py::object { return py::bool_(o.content.robot); }},
    {"backend", [](CameraOptions& o, const py::handle& v) { o.render.backend = backendOf(v); },
     [](const CameraOptions& o) -> py::object { return py::str(backendName(o.render.backend)); }},
    {"device", [](CameraOptions& o, const py::handle& v) { o.render.device = deviceOf(v); },
     [](const CameraOptions& o) -> py::object { return py::str(o.render.device); }},
    {"threads", [](CameraOptions& o, const py::handle& v) { o.render.threads = threadsOf(v); },
     [](const CameraOptions& o) -> py::object { return py::int_(o.render.threads); }},
};

/// Calls `f` with each option that adds noise to images, or jitter to cameras.
template <class F>
void forEachNoise(F&& f) {
  for (const auto& option : kImageNoiseOptions) f(option);
  for (const auto& option : kCameraJitterOptions) f(option);
}

std::vector<std::string> noiseNames() {
  std::vector<std::string> names;
  forEachNoise([&](const auto& option) { names.push_back(keywordOf(option.name)); });
  return names;
}

std::vector<std::string> keywordNames() {
  std::vector<std::string> names;
  for (const Keyword& keyword : kKeywords) names.emplace_back(keyword.name);
  std::ranges::move(noiseNames(), std::back_inserter(names));
  return names;
}

/// Sets the option of a keyword in `options`, if it is in `table`. Returns whether it is.
template <std::size_t count, class Options>
bool takeSensorOption(const std::array<SensorOption<Options>, count>& table,
                      const std::string& keyword, const py::handle& value, Options& options) {
  for (const SensorOption<Options>& option : table) {
    if (keywordOf(option.name) != keyword) continue;
    options.*option.value = drawnOf(keyword.c_str(), value, {0, option.most});
    return true;
  }
  return false;
}

/// Sets the option of a keyword in `options`. Returns whether the keyword exists.
bool takeKeyword(const std::string& keyword, const py::handle& value, CameraOptions& options) {
  const auto* known = std::ranges::find(kKeywords, std::string_view(keyword), &Keyword::name);
  if (known != std::end(kKeywords)) {
    known->take(options, value);
    return true;
  }
  return takeSensorOption(kImageNoiseOptions, keyword, value, options.render.noise) ||
         takeSensorOption(kCameraJitterOptions, keyword, value, options.camera.jitter);
}

CameraOptions defaultOptions() {
  CameraOptions options;
  options.render.color = ColorFormat::kRgb8;
  options.camera = {.name = "head",
                    .options = {.camera = "camera",
                                .fov = "fov_degrees",
                                .position = "position",
                                .rpy = "rpy_degrees",
                                .places = "world_from_camera",
                                .near = "near",
                                .jitter = "camera_jitter",
                                .jitter_degrees = "camera_jitter_degrees",
                                .jitter_fov = "camera_jitter_fov"}};
  return options;
}

/// A read-only view of a dictionary.
py::object readOnly(const py::dict& dictionary) {
  return py::module_::import("types").attr("MappingProxyType")(dictionary);
}

/// The default values of all keywords, by name.
py::object defaults() {
  const CameraOptions options = defaultOptions();
  py::dict values;
  for (const Keyword& keyword : kKeywords) {
    values[py::str(std::string(keyword.name))] = keyword.value(options);
  }
  for (const std::string& name : noiseNames()) values[py::str(name)] = 0.0;
  return readOnly(values);
}

/// The largest value of each keyword of noise.
py::object noiseLimits() {
  py::dict limits;
  forEachNoise([&](const auto& option) { limits[py::str(keywordOf(option.name))] = option.most; });
  return readOnly(limits);
}

/// The options from the keywords of Renderer and their defaults.
CameraOptions optionsFrom(const py::kwargs& keywords) {
  CameraOptions options = defaultOptions();
  for (const auto& [key, value] : keywords) {
    const auto name = key.cast<std::string>();
    if (!takeKeyword(name, value, options)) refuseKeyword(name, keywordNames());
  }
  // The default camera is on the robot, so it must not apply.
  if (!options.camera.world_from_camera.empty() && !keywords.contains("camera")) {
    options.camera.name.clear();
  }
  if (options.render.backend == RenderBackend::kSoft && !options.render.device.empty()) {
    throw ErrorException{
        {ErrorCode::kInvalidInput, "device",
         "is " + options.render.device +
             ", but the soft backend draws on the processor; leave it out, or take the "
             "backend cuda or gl"}};
  }
  return options;
}

void bindDeviceArray(py::module_& module) {
  py::class_<DeviceArray> type(module, "DeviceArray");
  type.def(
          "__dlpack__",
          // The unversioned capsule satisfies any `max_version`.
          [](const DeviceArray& one, const py::object& stream, const py::object&,
             const py::object& device, const py::object& copy) {
            return one.capsule({stream, device, copy});
          },
          py::kw_only(), py::arg("stream") = py::none(), py::arg("max_version") = py::none(),
          py::arg("dl_device") = py::none(), py::arg("copy") = py::none())
      .def("__dlpack_device__", &DeviceArray::device)
      .def_property_readonly(
          "shape", [](const DeviceArray& one) { return py::tuple(py::cast(one.shape())); });
  type.attr("__module__") = "galactic";
  type.doc() =
      "Images in the memory of a CUDA device, for from_dlpack() of an array library, without a\n"
      "copy.\n\n"
      "Their contents stay until the renderer draws again. Work that uses them must be enqueued\n"
      "before that, on the stream given to render_to_device(), or on one for which that stream\n"
      "waits.";
}

void bindDrawing(py::class_<Renderer>& type) {
  type.def("render", &Renderer::render, py::arg("out") = py::none(), py::arg("envs") = py::none(),
           "Draws the simulator's state and returns the images by name.\n\n"
           "out: arrays by name to draw into, of exactly the images' shape and type; missing\n"
           "ones are created. envs: numbers of the envs to draw, None for all.");
  type.def("begin_render", &Renderer::beginRender, py::arg("out") = py::none(),
           py::arg("envs") = py::none(),
           "The first half of render(): copies the state, so that the simulator may step in the\n"
           "meantime.");
  type.def("end_render", &Renderer::endRender,
           "The second half of render(): waits, and returns the images by name.");
  type.def(
      "render_to_device",
      [](Renderer& one, const py::object& stream) {
        return one.renderToDevice(
            wholeOf("stream", stream, 0, std::numeric_limits<std::uintptr_t>::max()));
      },
      py::arg("stream") = 0,
      "Draws all envs and leaves the images on the CUDA device, as DeviceArrays by name.\n\n"
      "stream: the CUDA stream that uses them, as a number, such as\n"
      "torch.cuda.current_stream().cuda_stream; 0 is the default stream. Work already enqueued\n"
      "on it finishes before the images change.\n\n"
      "Raises Error (UNSUPPORTED) with the soft backend, without CUDA, and with noise.");
}

/// Binds the place of the camera, and its lens.
void bindCamera(py::class_<Renderer>& type) {
  type.def(
      "place_camera",
      [](Renderer& one, const py::object& world_from_camera) {
        one.placeCamera(placesOf(world_from_camera));
      },
      py::arg("world_from_camera"),
      "Moves a camera that was made with world_from_camera, from the next drawing on: (4, 4)\n"
      "for all envs, or (num_envs, 4, 4), as the Renderer takes it. Raises Error, and does not\n"
      "move it, for a camera on the robot and for matrices that are not rigid transforms.\n"
      "Jitter and noise also depend on the place: back at the old one, they are the same again.");
  type.def_property_readonly(
      "intrinsics", &Renderer::intrinsics,
      "The camera matrix of all images, float32 (3, 3), or with camera_jitter_fov one for each\n"
      "env, as of the last drawing, (num_envs, 3, 3), pixels: (column, row, 1) of a point is\n"
      "intrinsics @ (x, y, z) / z, in the axes of world_from_camera. The center of the first\n"
      "pixel is (0.5, 0.5).");
  type.def_property_readonly(
      "world_from_camera", &Renderer::worldFromCameras,
      "Poses of the cameras of all envs in the last drawing: float32 (num_envs, 4, 4). The X\n"
      "axis of the camera's frame points to the right in the image, Y down, and Z ahead; depth\n"
      "is measured along Z.");
}

}  // namespace

void bindRenderer(py::module_& module) {
  bindDeviceArray(module);
  module.def(
      "look_at", &matricesOfLooks, py::arg("eye"), py::arg("target"),
      "The world_from_camera of a camera at `eye` that looks at `target`: float32 (4, 4), or\n"
      "(n, 4, 4) if either of them is several points.\n\n"
      "eye, target: points in the world, meters, (3,) or (n, 3). The camera is level: up in the\n"
      "world is up in its images. If it looks straight down, +X is up in the image, and -X if\n"
      "it looks straight up. Raises Error if both are the same point.");
  py::class_<Renderer> type(module, "Renderer");
  type.def(
      py::init([](const py::object& simulator, const py::kwargs& keywords) {
        (void)simulatorOf(simulator);
        return Renderer::create(simulator, optionsFrom(keywords));
      }),
      py::arg("simulator"),
      "Puts a camera into each env, on the robot or standing in the world.\n\n"
      "The simulator must have been made with body_transforms=True. Keywords: width=128,\n"
      "height=128, pixels; color='rgb', 'rgba' or None; depth=True; semantics=False, True or\n"
      "'objects'; camera='head', 'follow', 'top' or a link; or world_from_camera for a camera\n"
      "that stands in the world: a matrix (4, 4), or one for each env, (num_envs, 4, 4), as in\n"
      "the property of that name; fov_degrees, vertical, 1 to 175, or 0 for the camera's own,\n"
      "which is 90 on links and in the world; position=(0, 0, 0), offset from the place of the\n"
      "camera or link, meters ahead, to the left and up, and rpy_degrees=(0, 0, 0), its\n"
      "rotation there by roll, pitch (down is positive) and yaw, as in the [camera] of a\n"
      "robot's recipe; near, meters, the distance below which nothing is drawn, 0.01 to 100, or\n"
      "0 for the camera's own; robot=True, or False for images without the robot, but with what\n"
      "it holds; backend='auto', 'soft', 'gl' or 'cuda'; device='', or an index; threads=0.\n\n"
      "Matrices must be rotations to within 0.001, and at most 10 km from the origin.\n\n"
      "Options for images like those of real cameras, all 0 by default, each a number, or a\n"
      "range from which each episode draws one: depth_noise, the standard deviation of depth at\n"
      "1 m, meters, which grows with the square of depth; depth_dropout, the share of pixels\n"
      "without depth; color_noise, the standard deviation of each channel, in levels of 255;\n"
      "light_jitter, the share by which an episode may be brighter or darker; camera_jitter,\n"
      "meters, and camera_jitter_degrees, how far an episode may shift and turn the camera;\n"
      "camera_jitter_fov, degrees, how far it may change the field of view. Noise depends only\n"
      "on seed, env, episode and step: an image that is drawn twice is the same.");
  type.doc() =
      "Draws what cameras on a simulator's robots or in its homes see, for all envs together.\n\n"
      "Images by name: 'rgb' or 'rgba' uint8 (N, height, width, 3 or 4), sRGB; 'depth' float32\n"
      "(N, height, width), meters along the camera's axis, 0 where nothing is drawn;\n"
      "'semantics' int32 (N, height, width), indices into semantic_names. With\n"
      "semantics='objects', object n of an env, as in EnvState.objects, has the id\n"
      "len(semantic_names) + n instead.";
  type.attr("OPTIONS") = py::tuple(py::cast(keywordNames()));
  type.attr("NOISE_OPTIONS") = py::tuple(py::cast(noiseNames()));
  type.attr("NOISE_LIMITS") = noiseLimits();
  type.attr("DEFAULTS") = defaults();
  bindDrawing(type);
  bindCamera(type);
  type.def(
      "episode_noise", &Renderer::episodeNoise,
      "The noise of each env's episode in the last drawing, as drawn from the ranges in the\n"
      "options: depth_noise, depth_dropout, color_noise and light_jitter, float32 (num_envs,),\n"
      "copies.");
  type.def_property_readonly("shapes", &Renderer::shapes,
                             "Shape and dtype of one env's images, by name.");
  type.def_property_readonly(
      "backend", [](const Renderer& one) { return backendName(one.batch().backend()); },
      "What draws: 'soft', 'gl' or 'cuda'.");
  type.def_property_readonly(
      "description", [](const Renderer& one) { return one.batch().description(); },
      "The backend in words, with the device.");
  type.def_property_readonly("semantic_names", &Renderer::semanticNames,
                             "What the numbers in 'semantics' stand for.");
  type.def_property_readonly(
      "semantic_scenes", &Renderer::semanticScenes,
      "The scene of each of semantic_names, as scenes may use the same names: int32\n"
      "(len(semantic_names),), indices into World.scenes, -1 for the background, objects and\n"
      "links; a copy.");
  type.def("__repr__", [](const Renderer& one) {
    return fmt::format("<galactic.Renderer, {}>", one.batch().description());
  });
  type.attr("__module__") = "galactic";
  refusePickling(type, "make it again from its simulator");
}

}  // namespace galactic::python
