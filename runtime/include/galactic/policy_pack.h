#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "galactic/error.h"
#include "galactic/option_text.h"
#include "galactic/pack.h"

namespace galactic {

// The content of a policy pack (kind PLCY), for programs that write one. schema/policy.fbs explains
// each field; the names are the same.

namespace layer {

struct Observation {};
struct PreviousAction {};
struct Image {};
struct Constant {
  std::vector<float> values;
};
struct Normalize {
  std::vector<float> mean;
  std::vector<float> inverse_deviation;
  float limit = 10;
};
struct Linear {
  std::uint32_t outputs = 0;
  std::vector<float> weight;
  /// Empty: zeros, here and in the layers below.
  std::vector<float> bias;
};
struct Convolution {
  std::uint32_t outputs = 0;
  std::uint32_t kernel = 1;
  std::uint32_t stride = 1;
  std::uint32_t padding = 0;
  std::vector<float> weight;
  std::vector<float> bias;
};
struct GroupNorm {
  std::uint32_t groups = 1;
  float epsilon = 1e-5F;
  std::vector<float> weight;
  std::vector<float> bias;
};
struct LayerNorm {
  float epsilon = 1e-5F;
  std::vector<float> weight;
  std::vector<float> bias;
};
struct Relu {};
struct Tanh {};
struct Clamp {
  float lower = 0;
  float upper = 0;
};
struct SpaceToDepth {
  std::uint32_t block = 1;
};
struct AveragePool {
  std::uint32_t kernel = 1;
  std::uint32_t stride = 1;
  std::uint32_t padding = 0;
};
struct Sum {};
struct Concatenate {};
struct Slice {
  std::uint32_t first = 0;
  std::uint32_t size = 0;
};
struct Gru {
  std::uint32_t size = 0;
  std::vector<float> input_weight;
  std::vector<float> state_weight;
  std::vector<float> input_bias;
  std::vector<float> state_bias;
};

}  // namespace layer

/// A layer, and the numbers of the layers that it reads.
struct PolicyLayer {
  std::vector<std::uint32_t> inputs;
  std::variant<layer::Observation, layer::PreviousAction, layer::Image, layer::Constant,
               layer::Normalize, layer::Linear, layer::Convolution, layer::GroupNorm,
               layer::LayerNorm, layer::Relu, layer::Tanh, layer::Clamp, layer::SpaceToDepth,
               layer::AveragePool, layer::Sum, layer::Concatenate, layer::Slice, layer::Gru>
      kind;
};

/// A part of the observation that a policy reads.
struct PolicyPart {
  std::string name;
  std::uint32_t size = 0;

  friend bool operator==(const PolicyPart&, const PolicyPart&) = default;
};

/// The image that has to be drawn for a policy.
struct PolicyImage {
  /// Pixels.
  std::uint32_t width = 128;
  std::uint32_t height = 128;
  /// Which channels it has: red, green, blue; then depth.
  bool color = true;
  float color_scale = 1.0F / 255;
  bool depth = true;
  /// Meters.
  float depth_limit = 10;
  float depth_scale = 0.1F;
  /// As galactic-run --camera names it.
  std::string camera = "head";
  /// Radians; 0: the camera's own.
  float vertical_fov = 0;
  /// Where the camera is and how it is turned there, as in CameraWish.
  std::array<float, 3> position{};
  std::array<float, 3> rpy_degrees{};
  /// Meters; 0: the camera's own.
  float near = 0;

  /// The field of view as in CameraWish: rounded to thousandths of a degree, so that it is the
  /// number that was asked for.
  [[nodiscard]] float fovDegrees() const {
    constexpr double kThousandths = 180'000 / std::numbers::pi;
    return static_cast<float>(std::round(static_cast<double>(vertical_fov) * kThousandths) / 1000);
  }
  [[nodiscard]] std::uint32_t channels() const { return (color ? 3U : 0U) + (depth ? 1U : 0U); }
};

/// What a policy needs from a simulation.
struct PolicyInterface {
  std::string name;
  /// Empty: any robot with as many actions.
  std::string robot;
  /// Simulation options that observation and task need; other options do not matter.
  std::vector<OptionText> options;
  std::vector<PolicyPart> observation;
  std::optional<PolicyImage> image;
  /// Number of actions that are continuous; they come first.
  std::uint32_t continuous_actions = 0;
  /// Number of actions that take one of a few values.
  std::uint32_t discrete_actions = 0;
};

struct PolicyDiscreteAction {
  /// Number of a layer.
  std::uint32_t logits = 0;
  std::vector<float> values;
};

struct PolicyContinuousActions {
  std::uint32_t count = 0;
  /// Numbers of layers.
  std::uint32_t mean = 0;
  std::uint32_t log_deviation = 0;
};

/// Everything in a policy pack but the provenance.
struct PolicyContent {
  /// Its numbers of actions are not read: they follow from the fields below.
  PolicyInterface interface;
  std::vector<PolicyLayer> layers;
  std::optional<PolicyContinuousActions> continuous;
  std::vector<PolicyDiscreteAction> discrete;
};

/// Where a policy comes from.
struct PolicyProvenance {
  std::string tool;
  std::string tool_version;
  /// How it was trained, in as much detail as you like.
  std::vector<OptionText> options;
  /// The checkpoint's name; if empty, the pack lists no source. The writer hashes the checkpoint's
  /// bytes.
  std::string source_name;
  std::vector<std::byte> source;
};

/// The whole file: header and payload. The same content gives the same bytes. Nothing is checked.
[[nodiscard]] std::vector<std::byte> encodePolicyPack(const PolicyContent& content,
                                                      const PolicyProvenance& provenance);

/// Checks the content as opening the pack would, and writes the file atomically: it appears only
/// when it is complete. Fails with kInvalidInput, naming the layer and the field, and with kIo.
[[nodiscard]] Result<void> writePolicyPack(const std::filesystem::path& path,
                                           const PolicyContent& content,
                                           const PolicyProvenance& provenance);

/// What the policy in `pack` needs. Fails with kInvalidInput if it is another kind of pack.
[[nodiscard]] Result<PolicyInterface> policyInterface(const PackFile& pack);

}  // namespace galactic
