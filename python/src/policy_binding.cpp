// Policy packs: writes them from Python's description of a network, and plays them.
#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "arrays.h"
#include "bindings.h"
#include "confinement.h"
#include "galactic/error.h"
#include "galactic/learned_policy.h"
#include "galactic/option_text.h"
#include "galactic/policy_pack.h"
#include "options.h"

namespace galactic::python {
namespace {

using Path = std::filesystem::path;

/// A dictionary whose fields are read by name. Raises KeyError if one is missing.
class Fields {
 public:
  explicit Fields(py::dict dict) : dict_(std::move(dict)) {}

  template <class T>
  [[nodiscard]] T get(const char* name) const {
    return py::object(dict_[name]).cast<T>();
  }
  [[nodiscard]] bool has(const char* name) const {
    return dict_.contains(name) && !py::object(dict_[name]).is_none();
  }
  [[nodiscard]] std::vector<float> floats(const char* name) const {
    const auto array = get<InputArray<float>>(name);
    return {array.data(), array.data() + array.size()};
  }
  /// Empty if the field is missing or None.
  [[nodiscard]] std::vector<float> optionalFloats(const char* name) const {
    return has(name) ? floats(name) : std::vector<float>();
  }
  [[nodiscard]] std::uint32_t count(const char* name) const { return get<std::uint32_t>(name); }
  [[nodiscard]] float number(const char* name) const { return get<float>(name); }

 private:
  py::dict dict_;
};

using Kind = decltype(PolicyLayer::kind);

using LayerMaker = Kind (*)(const Fields&);

/// The functions that make each kind of layer, by the name that Python uses.
constexpr std::pair<std::string_view, LayerMaker> kLayerMakers[] = {
    {"observation", [](const Fields&) -> Kind { return layer::Observation{}; }},
    {"previous_action", [](const Fields&) -> Kind { return layer::PreviousAction{}; }},
    {"image", [](const Fields&) -> Kind { return layer::Image{}; }},
    {"constant", [](const Fields& f) -> Kind { return layer::Constant{f.floats("values")}; }},
    {"normalize",
     [](const Fields& f) -> Kind {
       return layer::Normalize{f.floats("mean"), f.floats("inverse_deviation"), f.number("limit")};
     }},
    {"linear",
     [](const Fields& f) -> Kind {
       return layer::Linear{f.count("outputs"), f.floats("weight"), f.optionalFloats("bias")};
     }},
    {"convolution",
     [](const Fields& f) -> Kind {
       return layer::Convolution{f.count("outputs"), f.count("kernel"),  f.count("stride"),
                                 f.count("padding"), f.floats("weight"), f.optionalFloats("bias")};
     }},
    {"group_norm",
     [](const Fields& f) -> Kind {
       return layer::GroupNorm{f.count("groups"), f.number("epsilon"), f.floats("weight"),
                               f.floats("bias")};
     }},
    {"layer_norm",
     [](const Fields& f) -> Kind {
       return layer::LayerNorm{f.number("epsilon"), f.floats("weight"), f.floats("bias")};
     }},
    {"relu", [](const Fields&) -> Kind { return layer::Relu{}; }},
    {"tanh", [](const Fields&) -> Kind { return layer::Tanh{}; }},
    {"clamp",
     [](const Fields& f) -> Kind {
       return layer::Clamp{f.number("lower"), f.number("upper")};
     }},
    {"space_to_depth",
     [](const Fields& f) -> Kind { return layer::SpaceToDepth{f.count("block")}; }},
    {"average_pool",
     [](const Fields& f) -> Kind {
       return layer::AveragePool{f.count("kernel"), f.count("stride"), f.count("padding")};
     }},
    {"sum", [](const Fields&) -> Kind { return layer::Sum{}; }},
    {"concatenate", [](const Fields&) -> Kind { return layer::Concatenate{}; }},
    {"slice",
     [](const Fields& f) -> Kind {
       return layer::Slice{f.count("first"), f.count("size")};
     }},
    {"gru", [](const Fields& f) -> Kind {
       return layer::Gru{f.count("size"), f.floats("input_weight"), f.floats("state_weight"),
                         f.floats("input_bias"), f.floats("state_bias")};
     }}};

PolicyLayer layerOf(const py::dict& dict) {
  const Fields fields(dict);
  const auto kind = fields.get<std::string>("kind");
  const auto* maker = std::ranges::find(kLayerMakers, std::string_view(kind),
                                        &std::pair<std::string_view, LayerMaker>::first);
  if (maker == std::end(kLayerMakers)) throw py::value_error("there is no layer " + kind);
  return {fields.get<std::vector<std::uint32_t>>("inputs"), maker->second(fields)};
}

PolicyImage imageOf(const Fields& fields) {
  return {.width = fields.count("width"),
          .height = fields.count("height"),
          .color = fields.get<bool>("color"),
          .color_scale = fields.number("color_scale"),
          .depth = fields.get<bool>("depth"),
          .depth_limit = fields.number("depth_limit"),
          .depth_scale = fields.number("depth_scale"),
          .camera = fields.get<std::string>("camera"),
          .vertical_fov = fields.number("vertical_fov"),
          .position = fields.get<std::array<float, 3>>("position"),
          .rpy_degrees = fields.get<std::array<float, 3>>("rpy_degrees"),
          .near = fields.number("near")};
}

std::vector<OptionText> textsOf(const py::dict& dict) {
  std::vector<OptionText> texts;
  for (const auto& [name, value] : dict) {
    texts.push_back({py::str(name).cast<std::string>(), py::str(value).cast<std::string>()});
  }
  return texts;
}

PolicyContent contentOf(const Fields& fields) {
  PolicyContent content;
  PolicyInterface& needs = content.interface;
  needs.name = fields.get<std::string>("name");
  needs.robot = fields.get<std::string>("robot");
  needs.options = taskTextsOf(fields.get<py::dict>("options"));
  for (const auto& [name, size] :
       fields.get<std::vector<std::pair<std::string, std::uint32_t>>>("observation")) {
    needs.observation.push_back({name, size});
  }
  if (fields.has("image")) needs.image = imageOf(Fields(fields.get<py::dict>("image")));
  for (const auto& dict : fields.get<std::vector<py::dict>>("layers")) {
    content.layers.push_back(layerOf(dict));
  }
  if (fields.has("continuous")) {
    const Fields continuous(fields.get<py::dict>("continuous"));
    content.continuous = {.count = continuous.count("count"),
                          .mean = continuous.count("mean"),
                          .log_deviation = continuous.count("log_deviation")};
  }
  for (const auto& dict : fields.get<std::vector<py::dict>>("discrete")) {
    const Fields action(dict);
    content.discrete.push_back({action.count("logits"), action.floats("values")});
  }
  return content;
}

void writePack(const Path& path, const py::dict& content, const py::dict& trained_with,
               const std::string& source_name, const py::bytes& source) {
  PolicyProvenance provenance{.tool = "galactic.export",
                              .tool_version = GALACTIC_VERSION,
                              .options = textsOf(trained_with),
                              .source_name = source_name,
                              .source = {}};
  const std::string_view bytes = source;
  const auto* first = reinterpret_cast<const std::byte*>(bytes.data());
  provenance.source.assign(first, first + bytes.size());
  const PolicyContent native = contentOf(Fields(content));
  const py::gil_scoped_release unlocked;
  orThrow(writePolicyPack(path, native, provenance));
}

/// Opens a policy pack. Has a helpful message for users who give a checkpoint instead.
PackFile openPolicy(const Path& path) {
  Result<PackFile> pack = PackFile::open(path);
  if (!pack && pack.error().code == ErrorCode::kInvalidInput && path.extension() == ".pt") {
    throw ErrorException{
        {ErrorCode::kInvalidInput, path.string(),
         "is a checkpoint, expected a policy pack; python3 -m galactic.export makes one "
         "of it"}};
  }
  return orThrow(std::move(pack));
}

/// A policy pack that acts on arrays, used by one thread at a time.
class PlayedPolicy {
 public:
  PlayedPolicy(const Path& path, const py::object& envs, const py::object& deterministic,
               const py::object& seed, const py::object& threads)
      : PlayedPolicy(openPolicy(path), wholeOf("envs", envs, 1, kMostEnvs),
                     {.samples = !truthOf("deterministic", deterministic),
                      .seed = wholeOf("seed", seed, 0, std::numeric_limits<std::uint64_t>::max()),
                      .threads = threadsOf(threads)}) {}

  py::array_t<float> act(const py::object& observations, const py::object& dones,
                         const py::object& rgb, const py::object& depth) {
    const Confinement::Use use = confinement_.enter();
    const auto envs = static_cast<py::ssize_t>(batch_.envs);
    const auto seen = inputOf<float>(observations, "observations",
                                     {envs, static_cast<py::ssize_t>(batch_.observation_size)});
    requireFinite(seen);
    PolicyInputs inputs{.observations = spanOf<float>(seen), .dones = {}, .color = {}, .depth = {}};
    // Converted arrays must live until the policy has acted.
    py::object done_rows = dones;
    py::object rgb_rows = rgb;
    py::object depth_rows = depth;
    if (!dones.is_none()) {
      done_rows = inputOf<std::uint8_t>(dones, "dones", {envs});
      inputs.dones = spanOf<std::uint8_t>(done_rows);
    }
    const auto& image = policy_.interface().image;
    if (!image || !image->color) refuseUnseen(rgb, "rgb");
    if (!image || !image->depth) refuseUnseen(depth, "depth");
    if (image) {
      const auto height = static_cast<py::ssize_t>(image->height);
      const auto width = static_cast<py::ssize_t>(image->width);
      if (image->color) {
        rgb_rows = inputOf<std::uint8_t>(rgb, "rgb", {envs, height, width, 3});
        inputs.color = spanOf<std::uint8_t>(rgb_rows);
      }
      if (image->depth) {
        depth_rows = inputOf<float>(depth, "depth", {envs, height, width});
        inputs.depth = spanOf<float>(depth_rows);
      }
    }
    py::array_t<float> actions({batch_.envs, batch_.actions});
    const std::span<float> out(actions.mutable_data(), static_cast<std::size_t>(actions.size()));
    const py::gil_scoped_release unlocked;
    policy_.act(inputs, out);
    return actions;
  }

  void reset() {
    const Confinement::Use use = confinement_.enter();
    policy_.reset();
  }
  [[nodiscard]] const PolicyInterface& needs() const { return policy_.interface(); }
  [[nodiscard]] std::size_t actionCount() const { return batch_.actions; }

 private:
  /// The largest number of envs of a simulator.
  static constexpr std::uint64_t kMostEnvs = 1U << 20U;

  PlayedPolicy(const PackFile& pack, std::size_t envs, const LearnedPolicyOptions& options)
      : batch_(batchOf(orThrow(policyInterface(pack)), envs)),
        policy_(orThrow(LearnedPolicy::create(pack, batch_, options))) {}

  static void refuseUnseen(const py::object& given, const char* name) {
    if (given.is_none()) return;
    throw py::value_error(
        fmt::format("{} is a {}, and the policy does not see it: `images` says what it sees", name,
                    typeName(given)));
  }

  static void requireFinite(const py::array_t<float>& rows) {
    const std::span<const float> numbers(rows.data(), static_cast<std::size_t>(rows.size()));
    const auto wrong =
        std::ranges::find_if_not(numbers, [](float one) { return std::isfinite(one); });
    if (wrong == numbers.end()) return;
    const auto place = wrong - numbers.begin();
    throw py::value_error(fmt::format("observations[{}, {}] is {}, expected finite numbers",
                                      place / rows.shape(1), place % rows.shape(1), *wrong));
  }

  template <class T>
  static std::span<const T> spanOf(const py::object& array) {
    const auto rows = py::cast<py::array_t<T>>(array);
    return {rows.data(), static_cast<std::size_t>(rows.size())};
  }

  /// A batch with exactly what the policy needs.
  static PolicyBatch batchOf(const PolicyInterface& needs, std::size_t envs) {
    PolicyBatch batch;
    batch.envs = envs;
    batch.actions = std::size_t{needs.continuous_actions} + needs.discrete_actions;
    for (const PolicyPart& part : needs.observation) {
      batch.observation.push_back({part.name, batch.observation_size, part.size});
      batch.observation_size += part.size;
    }
    return batch;
  }

  Confinement confinement_{"LearnedPolicy"};
  PolicyBatch batch_;
  LearnedPolicy policy_;
};

py::list observationOf(const PlayedPolicy& policy) {
  py::list parts;
  for (const PolicyPart& part : policy.needs().observation) {
    parts.append(py::make_tuple(part.name, part.size));
  }
  return parts;
}

py::object imagesOf(const PlayedPolicy& policy) {
  const auto& image = policy.needs().image;
  if (!image) return py::none();
  py::dict options;
  options["width"] = image->width;
  options["height"] = image->height;
  options["color"] = image->color ? py::object(py::str("rgb")) : py::object(py::none());
  options["depth"] = image->depth;
  options["camera"] = image->camera;
  options["fov_degrees"] = image->fovDegrees();
  options["position"] = py::tuple(py::cast(image->position));
  options["rpy_degrees"] = py::tuple(py::cast(image->rpy_degrees));
  options["near"] = image->near;
  return options;
}

}  // namespace

void bindPolicy(py::module_& module) {
  module.def("write_policy_pack", &writePack, py::arg("path"), py::arg("content"),
             py::arg("trained_with"), py::arg("source_name"), py::arg("source"),
             "Checks a policy pack and writes it atomically. For the contents of the\n"
             "dictionaries, see galactic.export.");
  py::class_<PlayedPolicy> type(module, "LearnedPolicy",
                                R"(A policy pack, played without torch.

It acts in `envs` environments at a time. A row of observations is the concatenation of the parts
that `observation` lists. The policy keeps recurrent states and previous actions for each row.
Actions do not depend on the number of threads or on the other envs.)");
  type.def(py::init<const Path&, const py::object&, const py::object&, const py::object&,
                    const py::object&>(),
           py::arg("path"), py::arg("envs"), py::kw_only(), py::arg("deterministic") = false,
           py::arg("seed") = 1, py::arg("threads") = 0)
      .def("act", &PlayedPolicy::act, py::arg("observations"), py::arg("dones") = py::none(),
           py::arg("rgb") = py::none(), py::arg("depth") = py::none(),
           R"(The actions [envs, actions] of the next step, float32, as Simulator.step takes them.

observations  [envs, S] float32, finite
dones         [envs] bool or uint8: whether an episode ended in the last step; None: in no env
rgb           [envs, height, width, 3] uint8 if the policy sees colors, else None
depth         [envs, height, width] float32, meters, if the policy sees depth, else None)")
      .def("reset", &PlayedPolicy::reset, "All envs begin new episodes.")
      .def_property_readonly(
          "name", [](const PlayedPolicy& p) { return p.needs().name; }, "The policy's name.")
      .def_property_readonly(
          "robot", [](const PlayedPolicy& p) { return p.needs().robot; },
          "Name of the robot that the policy moves; empty: any.")
      .def_property_readonly(
          "options", [](const PlayedPolicy& p) { return keywordsOf(p.needs().options); },
          "The options of its training's simulation, as keywords of Simulator and VectorEnv.")
      .def_property_readonly("observation", &observationOf,
                             "Names and sizes of the observation parts that the policy reads,\n"
                             "in order.")
      .def_property_readonly("images", &imagesOf,
                             "The options of a Renderer that draws the images that the policy\n"
                             "needs, as VectorEnv takes them; None if it needs no images.")
      .def("__repr__",
           [](const PlayedPolicy& p) { return "<galactic.LearnedPolicy " + p.needs().name + ">"; })
      .def_property_readonly("action_count", &PlayedPolicy::actionCount, "Columns of the actions.");
  type.attr("__module__") = "galactic";
  refusePickling(type, "make one from the same pack");
}

}  // namespace galactic::python
