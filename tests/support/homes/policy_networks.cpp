#include "support/homes/policy_networks.h"

#include <cmath>
#include <utility>

namespace galactic::test {
namespace {

/// The scale of weights of a layer with so many terms.
float scaleFor(std::size_t terms) { return std::sqrt(3.0F / static_cast<float>(terms)); }

constexpr std::uint32_t kWidth = 512;

/// A residual block; returns its last layer.
std::uint32_t residualBlock(PolicyBuilder& b, std::uint32_t from,
                            const PolicyBuilder::Kernel& kernel) {
  constexpr std::uint32_t kGroups = 16;
  std::uint32_t x = b.convolution(from, kernel);
  x = b.relu(b.groupNorm(x, kernel.outputs, kGroups));
  x = b.convolution(x,
                    {.inputs = kernel.outputs, .outputs = kernel.outputs, .size = 3, .padding = 1});
  x = b.groupNorm(x, kernel.outputs, kGroups);
  std::uint32_t around = from;
  if (kernel.stride != 1) {
    around =
        b.add({{around}, layer::AveragePool{.kernel = 3, .stride = kernel.stride, .padding = 1}});
  }
  if (kernel.stride != 1 || kernel.inputs != kernel.outputs) {
    around = b.convolution(around, {.inputs = kernel.inputs, .outputs = kernel.outputs});
    around = b.groupNorm(around, kernel.outputs, kGroups);
  }
  return b.relu(b.add({{x, around}, layer::Sum{}}));
}

std::uint32_t resNet(PolicyBuilder& b, std::uint32_t image, std::uint32_t blocks) {
  constexpr std::uint32_t kGroups = 16;
  std::uint32_t x = b.add({{image}, layer::SpaceToDepth{.block = 4}});
  x = b.convolution(x, {.inputs = 64, .outputs = 32});
  x = b.relu(b.groupNorm(x, 32, kGroups));
  std::uint32_t channels = 32;
  for (std::uint32_t stage = 0; stage < 4; ++stage) {
    for (std::uint32_t block = 0; block < blocks; ++block) {
      const std::uint32_t width = 32U << stage;
      const std::uint32_t stride = stage > 0 && block == 0 ? 2 : 1;
      x = residualBlock(
          b, x, {.inputs = channels, .outputs = width, .size = 3, .stride = stride, .padding = 1});
      channels = width;
    }
  }
  x = b.convolution(x, {.inputs = 256, .outputs = 64, .size = 3, .padding = 1});
  x = b.relu(b.groupNorm(x, 64, kGroups));
  x = b.linear(x, 64 * 4 * 4, kWidth, false);
  return b.relu(b.layerNorm(x, kWidth));
}

std::uint32_t simpleCnn(PolicyBuilder& b, std::uint32_t image) {
  std::uint32_t x =
      b.convolution(image, {.inputs = 4, .outputs = 32, .size = 8, .stride = 4, .bias = true});
  x = b.convolution(b.relu(x), {.inputs = 32, .outputs = 64, .size = 4, .stride = 2, .bias = true});
  x = b.convolution(b.relu(x), {.inputs = 64, .outputs = 32, .size = 3, .bias = true});
  return b.relu(b.linear(x, 32 * 12 * 12, kWidth));
}

/// For 64 x 64 pixels of depth.
std::uint32_t depthCnn(PolicyBuilder& b, std::uint32_t image, std::uint32_t features) {
  std::uint32_t x =
      b.convolution(image, {.inputs = 1, .outputs = 16, .size = 8, .stride = 4, .bias = true});
  x = b.convolution(b.relu(x), {.inputs = 16, .outputs = 32, .size = 4, .stride = 2, .bias = true});
  x = b.convolution(b.relu(x), {.inputs = 32, .outputs = 32, .size = 3, .bias = true});
  return b.relu(b.linear(b.relu(x), 32 * 4 * 4, features));
}

}  // namespace

std::uint32_t PolicyBuilder::add(PolicyLayer layer) {
  content.layers.push_back(std::move(layer));
  return static_cast<std::uint32_t>(content.layers.size() - 1);
}

std::uint32_t PolicyBuilder::linear(std::uint32_t from, std::uint32_t inputs, std::uint32_t outputs,
                                    bool bias) {
  layer::Linear kind{.outputs = outputs,
                     .weight = weights_.take(std::size_t{inputs} * outputs, scaleFor(inputs)),
                     .bias = {}};
  if (bias) kind.bias = weights_.take(outputs, 0.1F);
  return add({{from}, std::move(kind)});
}

std::uint32_t PolicyBuilder::convolution(std::uint32_t from, const Kernel& kernel) {
  const std::size_t terms = std::size_t{kernel.inputs} * kernel.size * kernel.size;
  layer::Convolution kind{.outputs = kernel.outputs,
                          .kernel = kernel.size,
                          .stride = kernel.stride,
                          .padding = kernel.padding,
                          .weight = weights_.take(terms * kernel.outputs, scaleFor(terms)),
                          .bias = {}};
  if (kernel.bias) kind.bias = weights_.take(kernel.outputs, 0.1F);
  return add({{from}, std::move(kind)});
}

std::uint32_t PolicyBuilder::groupNorm(std::uint32_t from, std::uint32_t channels,
                                       std::uint32_t groups) {
  return add({{from},
              layer::GroupNorm{.groups = groups,
                               .epsilon = 1e-5F,
                               .weight = weights_.take(channels, 0.2F, 1),
                               .bias = weights_.take(channels, 0.2F)}});
}

std::uint32_t PolicyBuilder::layerNorm(std::uint32_t from, std::uint32_t size) {
  return add({{from},
              layer::LayerNorm{.epsilon = 1e-5F,
                               .weight = weights_.take(size, 0.2F, 1),
                               .bias = weights_.take(size, 0.2F)}});
}

std::uint32_t PolicyBuilder::normalize(std::uint32_t from, std::uint32_t channels) {
  return add({{from},
              layer::Normalize{.mean = weights_.take(channels, 0.5F),
                               .inverse_deviation = weights_.take(channels, 0.5F, 1),
                               .limit = 10}});
}

std::uint32_t PolicyBuilder::gru(std::uint32_t from, std::uint32_t inputs, std::uint32_t size) {
  const std::size_t gates = 3 * std::size_t{size};
  return add({{from},
              layer::Gru{.size = size,
                         .input_weight = weights_.take(gates * inputs, scaleFor(inputs)),
                         .state_weight = weights_.take(gates * size, scaleFor(size)),
                         .input_bias = weights_.take(gates, 0.1F),
                         .state_bias = weights_.take(gates, 0.1F)}});
}

void PolicyBuilder::heads(std::uint32_t from, std::uint32_t size, std::uint32_t continuous) {
  const std::uint32_t all = linear(from, size, 2 * continuous + 4);
  const auto part = [&](std::uint32_t first, std::uint32_t count) {
    return add({{all}, layer::Slice{.first = first, .size = count}});
  };
  const std::uint32_t mean = tanh(part(0, continuous));
  const std::uint32_t log_deviation =
      add({{part(continuous, continuous)}, layer::Clamp{.lower = -5, .upper = 2}});
  content.continuous = {.count = continuous, .mean = mean, .log_deviation = log_deviation};
  for (const std::uint32_t first : {2 * continuous, 2 * continuous + 2}) {
    content.discrete.push_back({.logits = part(first, 2), .values = {0, 1}});
  }
}

std::vector<PolicyPart> plainObservation(std::uint32_t joints) {
  return {{"robot_target", 3}, {"grip_target", 3}, {"robot_grip", 3},  {"robot_goal", 3},
          {"grip_goal", 3},    {"is_holding", 1},  {"joints", joints}, {"time", 3}};
}

PolicyContent policyNetwork(const std::string& name, std::uint64_t seed) {
  constexpr std::uint32_t kState = 26;
  PolicyBuilder b(seed);
  b.content.interface.name = name;
  b.content.interface.observation = plainObservation();
  std::uint32_t x = b.add({{}, layer::Observation{}});
  if (name == "state" || name == "state_gru" || name == "depth_gru") {
    constexpr std::uint32_t kHidden = 128;
    x = b.normalize(x, kState);
    std::uint32_t size = kState;
    if (name == "depth_gru") {
      b.content.interface.image = PolicyImage{.width = 64, .height = 64, .color = false};
      x = b.add({{x, depthCnn(b, b.add({{}, layer::Image{}}), kHidden)}, layer::Concatenate{}});
      size += kHidden;
    }
    x = b.tanh(b.linear(x, size, kHidden));
    x = b.tanh(b.linear(x, kHidden, kHidden));
    if (name != "state") x = b.gru(x, kHidden, kHidden);
    b.heads(x, kHidden);
    return std::move(b.content);
  }
  b.content.interface.image = PolicyImage{};
  const std::uint32_t image = b.add({{}, layer::Image{}});
  if (name == "simple_cnn") {
    const std::uint32_t seen = simpleCnn(b, image);
    x = b.gru(b.add({{seen, x}, layer::Concatenate{}}), kWidth + kState, kWidth);
  } else {
    constexpr std::uint32_t kPrevious = 32;
    const std::uint32_t seen = resNet(b, image, name == "resnet9" ? 1 : 2);
    const std::uint32_t felt = b.linear(x, kState, kWidth);
    const std::uint32_t did = b.linear(b.add({{}, layer::PreviousAction{}}), 11, kPrevious);
    x = b.gru(b.add({{seen, felt, did}, layer::Concatenate{}}), 2 * kWidth + kPrevious, kWidth);
  }
  b.heads(x, kWidth);
  return std::move(b.content);
}

PolicyContent smallPolicy() {
  PolicyBuilder b(7);
  PolicyInterface& needs = b.content.interface;
  needs.name = "picker";
  needs.robot = "helper";
  needs.options = {{.name = "task", .value = "pick"}, {.name = "episode-steps", .value = "300"}};
  needs.observation = {{"grip_target", 3}, {"is_holding", 1}};
  needs.image = PolicyImage{.width = 6, .height = 4};
  const std::uint32_t observation = b.add({{}, layer::Observation{}});  // 0
  const std::uint32_t previous = b.add({{}, layer::PreviousAction{}});  // 1
  const std::uint32_t image = b.add({{}, layer::Image{}});              // 2
  std::uint32_t x = b.add({{image}, layer::SpaceToDepth{.block = 2}});  // 3: 16 x 2 x 3
  x = b.convolution(x, {.inputs = 16,
                        .outputs = 4,
                        .size = 3,
                        .stride = 1,
                        .padding = 1,
                        .bias = true});                                          // 4: 4 x 2 x 3
  const std::uint32_t normed = b.groupNorm(x, 4, 2);                             // 5
  x = b.relu(b.add({{x, normed}, layer::Sum{}}));                                // 6, 7
  x = b.add({{x}, layer::AveragePool{.kernel = 2, .stride = 2, .padding = 1}});  // 8: 4 x 2 x 2
  x = b.layerNorm(b.linear(x, 16, 5, false), 5);                                 // 9, 10
  const std::uint32_t felt = b.normalize(observation, 4);                        // 11
  x = b.add({{x, felt, previous}, layer::Concatenate{}});                        // 12: 12
  x = b.gru(x, 12, 3);                                                           // 13
  const std::uint32_t heads = b.linear(x, 3, 4);                                 // 14
  const std::uint32_t mean =
      b.tanh(b.add({{heads}, layer::Slice{.first = 0, .size = 2}}));                   // 15, 16
  const std::uint32_t logits = b.add({{heads}, layer::Slice{.first = 2, .size = 2}});  // 17
  const std::uint32_t constant = b.add({{}, layer::Constant{.values = {-0.5F, -7}}});  // 18
  const std::uint32_t deviation = b.add({{constant}, layer::Clamp{.lower = -5, .upper = 2}});  // 19
  b.content.continuous = {.count = 2, .mean = mean, .log_deviation = deviation};
  b.content.discrete = {{.logits = logits, .values = {0, 1}}};
  return std::move(b.content);
}

PolicyProvenance smallPolicyProvenance() {
  const std::string source = "a checkpoint";
  const auto* bytes = reinterpret_cast<const std::byte*>(source.data());
  return {.tool = "galactic.export",
          .tool_version = "0.1.0",
          .options = {{.name = "network", .value = "state", .is_word = true}},
          .source_name = "best.pt",
          .source = {bytes, bytes + source.size()}};
}

}  // namespace galactic::test
