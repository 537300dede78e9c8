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

// The content of a policy pack (kind PLCY), for those who write one. schema/policy.fbs says what
// each field means; the names are the same.

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
  /// Empty: zeros; the same below.
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

/// A layer and the numbers of the layers that it reads.
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

/// What has to be drawn for a policy.
struct PolicyImage {
  /// Pixels.
  std::uint32_t width = 128;
  std::uint32_t height = 128;
  /// Which channels it has: red, green, blue; and behind them the depth.
  bool color = true;
  float color_scale = 1.0F / 255;
  bool depth = true;
  /// Meters.
  float depth_limit = 10;
  float depth_scale = 0.1F;
  /// As galactic-run --camera names it.
  std::string camera = "head";
  /// Radians; 0: that of the camera.
  float vertical_fov = 0;
  /// Where the camera is and how it is turned there, as CameraWish has them.
  std::array<float, 3> position{};
  std::array<float, 3> rpy_degrees{};
  /// Meters; 0: what belongs to the camera.
  float near = 0;

  /// As CameraWish has it: rounded to thousandths, so that it is what somebody asked for.
  [[nodiscard]] float fovDegrees() const {
    constexpr double kThousandths = 180'000 / std::numbers::pi;
    return static_cast<float>(std::round(static_cast<double>(vertical_fov) * kThousandths) / 1000);
  }
  [[nodiscard]] std::uint32_t channels() const { return (color ? 3U : 0U) + (depth ? 1U : 0U); }
};

/// What a policy needs to know and to be given.
struct PolicyInterface {
  std::string name;
  /// Empty: any robot with as many actions.
  std::string robot;
  /// Options of a simulation that observation and task need; the others do not matter.
  std::vector<OptionText> options;
  std::vector<PolicyPart> observation;
  std::optional<PolicyImage> image;
  /// How many actions are numbers; they come first.
  std::uint32_t continuous_actions = 0;
  /// How many have one of a few values.
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

/// All of a policy.
struct PolicyContent {
  /// Its counts of actions follow from what is below and are not read.
  PolicyInterface interface;
  std::vector<PolicyLayer> layers;
  std::optional<PolicyContinuousActions> continuous;
  std::vector<PolicyDiscreteAction> discrete;
};

/// Where a policy comes from.
struct PolicyProvenance {
  std::string tool;
  std::string tool_version;
  /// How it was trained, as far as one wants to know.
  std::vector<OptionText> options;
  /// The checkpoint; no source when it has no name. Its bytes are hashed by the writer.
  std::string source_name;
  std::vector<std::byte> source;
};

/// The whole file: header and payload. Same content, same bytes. Nothing is checked.
[[nodiscard]] std::vector<std::byte> encodePolicyPack(const PolicyContent& content,
                                                      const PolicyProvenance& provenance);

/// Checks the content as opening the pack would and writes it, so that it appears when it is whole.
/// Fails with kInvalidInput, naming the layer and the field, and with kIo.
[[nodiscard]] Result<void> writePolicyPack(const std::filesystem::path& path,
                                           const PolicyContent& content,
                                           const PolicyProvenance& provenance);

/// What the policy in `pack` needs. Fails with kInvalidInput on another kind of pack.
[[nodiscard]] Result<PolicyInterface> policyInterface(const PackFile& pack);

}  // namespace galactic
