#include "support/oracles/policy_oracle.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace galactic::test {
namespace {

struct Value {
  std::size_t channels = 0;
  std::size_t height = 1;
  std::size_t width = 1;
  std::vector<double> at;

  [[nodiscard]] double pixel(std::size_t c, std::ptrdiff_t y, std::ptrdiff_t x) const {
    const auto h = static_cast<std::ptrdiff_t>(height);
    const auto w = static_cast<std::ptrdiff_t>(width);
    if (y < 0 || y >= h || x < 0 || x >= w) return 0;
    return at[(c * height + static_cast<std::size_t>(y)) * width + static_cast<std::size_t>(x)];
  }
};

Value vectorOf(std::vector<double> at) {
  const std::size_t size = at.size();
  return {.channels = size, .at = std::move(at)};
}

Value vectorOf(const std::vector<float>& at) {
  return vectorOf(std::vector<double>(at.begin(), at.end()));
}

double sigmoid(double x) { return 1 / (1 + std::exp(-x)); }

/// weight x + bias.
std::vector<double> product(const std::vector<float>& weight, const std::vector<float>& bias,
                            const std::vector<double>& x) {
  std::vector<double> y(weight.size() / x.size());
  for (std::size_t n = 0; n < y.size(); ++n) {
    for (std::size_t k = 0; k < x.size(); ++k) {
      y[n] += static_cast<double>(weight[n * x.size() + k]) * x[k];
    }
    if (!bias.empty()) y[n] += static_cast<double>(bias[n]);
  }
  return y;
}

/// (x - mean) / sqrt(variance + epsilon) of the range.
void standardize(std::vector<double>& at, std::size_t first, std::size_t count, float epsilon) {
  double mean = 0;
  for (std::size_t n = first; n < first + count; ++n) mean += at[n] / static_cast<double>(count);
  double variance = 0;
  for (std::size_t n = first; n < first + count; ++n) {
    variance += std::pow(at[n] - mean, 2) / static_cast<double>(count);
  }
  for (std::size_t n = first; n < first + count; ++n) {
    at[n] = (at[n] - mean) / std::sqrt(variance + static_cast<double>(epsilon));
  }
}

template <class Layer>
Value scaled(Value x, const Layer& kind) {
  const std::size_t pixels = x.height * x.width;
  for (std::size_t n = 0; n < x.at.size(); ++n) {
    x.at[n] = x.at[n] * static_cast<double>(kind.weight[n / pixels]) +
              static_cast<double>(kind.bias[n / pixels]);
  }
  return x;
}

/// The shape of what a kernel makes of `x`, without channels.
template <class Layer>
Value placed(const Value& x, const Layer& kind, std::size_t channels) {
  Value y{.channels = channels,
          .height = (x.height + 2 * kind.padding - kind.kernel) / kind.stride + 1,
          .width = (x.width + 2 * kind.padding - kind.kernel) / kind.stride + 1,
          .at = {}};
  y.at.resize(channels * y.height * y.width);
  return y;
}

/// Computes one layer.
struct Evaluate {
  const PolicyContent& content;
  const PolicySight& sight;
  const std::vector<Value>& inputs;
  std::vector<double>& state;

  Value operator()(const layer::Observation&) const { return vectorOf(sight.observation); }
  Value operator()(const layer::PreviousAction&) const { return vectorOf(sight.previous_actions); }
  Value operator()(const layer::Image&) const {
    const PolicyImage& image = *content.interface.image;
    Value y{.channels = image.channels(), .height = image.height, .width = image.width, .at = {}};
    const std::size_t pixels = y.height * y.width;
    for (std::size_t c = 0; image.color && c < 3; ++c) {
      for (std::size_t p = 0; p < pixels; ++p) {
        y.at.push_back(sight.color[3 * p + c] * static_cast<double>(image.color_scale));
      }
    }
    for (std::size_t p = 0; image.depth && p < pixels; ++p) {
      y.at.push_back(static_cast<double>(std::min(sight.depth[p], image.depth_limit)) *
                     static_cast<double>(image.depth_scale));
    }
    return y;
  }
  Value operator()(const layer::Constant& kind) const { return vectorOf(kind.values); }
  Value operator()(const layer::Normalize& kind) const {
    Value y = inputs[0];
    const std::size_t pixels = y.height * y.width;
    const auto limit = static_cast<double>(kind.limit);
    for (std::size_t n = 0; n < y.at.size(); ++n) {
      y.at[n] = std::clamp((y.at[n] - static_cast<double>(kind.mean[n / pixels])) *
                               static_cast<double>(kind.inverse_deviation[n / pixels]),
                           -limit, limit);
    }
    return y;
  }
  Value operator()(const layer::Linear& kind) const {
    return vectorOf(product(kind.weight, kind.bias, inputs[0].at));
  }
  Value operator()(const layer::Convolution& kind) const {
    const Value& x = inputs[0];
    Value y = placed(x, kind, kind.outputs);
    const std::size_t square = kind.kernel * kind.kernel;
    for (std::size_t n = 0; n < y.at.size(); ++n) {
      const std::size_t output = n / (y.height * y.width);
      if (!kind.bias.empty()) y.at[n] = static_cast<double>(kind.bias[output]);
      for (std::size_t t = 0; t < square * x.channels; ++t) {
        const std::size_t row = t % square / kind.kernel;
        const std::size_t column = t % kind.kernel;
        y.at[n] += static_cast<double>(kind.weight[output * square * x.channels + t]) *
                   under(x, y, n, kind, row, column, t / square);
      }
    }
    return y;
  }
  Value operator()(const layer::AveragePool& kind) const {
    const Value& x = inputs[0];
    Value y = placed(x, kind, x.channels);
    const double count = static_cast<double>(kind.kernel) * kind.kernel;
    for (std::size_t n = 0; n < y.at.size(); ++n) {
      for (std::size_t t = 0; t < std::size_t{kind.kernel} * kind.kernel; ++t) {
        y.at[n] +=
            under(x, y, n, kind, t / kind.kernel, t % kind.kernel, n / (y.height * y.width)) /
            count;
      }
    }
    return y;
  }
  Value operator()(const layer::GroupNorm& kind) const {
    Value y = inputs[0];
    const std::size_t size = y.at.size() / kind.groups;
    for (std::size_t g = 0; g < kind.groups; ++g) standardize(y.at, g * size, size, kind.epsilon);
    return scaled(std::move(y), kind);
  }
  Value operator()(const layer::LayerNorm& kind) const {
    Value y = inputs[0];
    standardize(y.at, 0, y.at.size(), kind.epsilon);
    return scaled(std::move(y), kind);
  }
  Value operator()(const layer::Relu&) const {
    return each([](double x) { return std::max(x, 0.0); });
  }
  Value operator()(const layer::Tanh&) const {
    return each([](double x) { return std::tanh(x); });
  }
  Value operator()(const layer::Clamp& kind) const {
    return each([&](double x) {
      return std::clamp(x, static_cast<double>(kind.lower), static_cast<double>(kind.upper));
    });
  }
  Value operator()(const layer::SpaceToDepth& kind) const {
    const Value& x = inputs[0];
    Value y{.channels = x.channels * kind.block * kind.block,
            .height = x.height / kind.block,
            .width = x.width / kind.block,
            .at = {}};
    for (std::size_t c = 0; c < y.channels; ++c) {
      const std::size_t row = c / x.channels / kind.block;
      const std::size_t column = c / x.channels % kind.block;
      for (std::size_t p = 0; p < y.height * y.width; ++p) {
        y.at.push_back(x.pixel(c % x.channels,
                               static_cast<std::ptrdiff_t>(p / y.width * kind.block + row),
                               static_cast<std::ptrdiff_t>(p % y.width * kind.block + column)));
      }
    }
    return y;
  }
  Value operator()(const layer::Sum&) const {
    Value y = inputs[0];
    for (std::size_t n = 0; n < y.at.size(); ++n) y.at[n] += inputs[1].at[n];
    return y;
  }
  Value operator()(const layer::Concatenate&) const {
    std::vector<double> all;
    for (const Value& x : inputs) all.insert(all.end(), x.at.begin(), x.at.end());
    return vectorOf(std::move(all));
  }
  Value operator()(const layer::Slice& kind) const {
    const auto first = inputs[0].at.begin() + kind.first;
    return vectorOf(std::vector<double>(first, first + kind.size));
  }
  Value operator()(const layer::Gru& kind) const {
    if (state.empty()) state.resize(kind.size);
    const std::vector<double> x = product(kind.input_weight, kind.input_bias, inputs[0].at);
    const std::vector<double> h = product(kind.state_weight, kind.state_bias, state);
    for (std::size_t n = 0; n < kind.size; ++n) {
      const double reset = sigmoid(x[n] + h[n]);
      const double keep = sigmoid(x[kind.size + n] + h[kind.size + n]);
      const double fresh = std::tanh(x[2 * kind.size + n] + reset * h[2 * kind.size + n]);
      state[n] = (1 - keep) * fresh + keep * state[n];
    }
    return vectorOf(state);
  }

 private:
  template <class Function>
  [[nodiscard]] Value each(const Function& function) const {
    Value y = inputs[0];
    std::ranges::transform(y.at, y.at.begin(), function);
    return y;
  }

  /// What lies under the kernel's element (row, column) for element `n` of `y`.
  template <class Layer>
  static double under(const Value& x, const Value& y, std::size_t n, const Layer& kind,
                      std::size_t row, std::size_t column, std::size_t channel) {
    const std::size_t pixel = n % (y.height * y.width);
    const auto padding = static_cast<std::ptrdiff_t>(kind.padding);
    return x.pixel(channel,
                   static_cast<std::ptrdiff_t>(pixel / y.width * kind.stride + row) - padding,
                   static_cast<std::ptrdiff_t>(pixel % y.width * kind.stride + column) - padding);
  }
};

}  // namespace

PolicyOracle::PolicyOracle(const PolicyContent& content)
    : content_(content), states_(content.layers.size()) {}

std::vector<std::vector<double>> PolicyOracle::run(const PolicySight& sight) {
  std::vector<Value> values;
  for (std::size_t n = 0; n < content_.layers.size(); ++n) {
    std::vector<Value> inputs;
    for (const std::uint32_t input : content_.layers[n].inputs) inputs.push_back(values[input]);
    values.push_back(
        std::visit(Evaluate{content_, sight, inputs, states_[n]}, content_.layers[n].kind));
  }
  std::vector<std::vector<double>> all;
  for (Value& value : values) all.push_back(std::move(value.at));
  return all;
}

void PolicyOracle::reset() {
  for (std::vector<double>& state : states_) state.clear();
}

std::vector<double> PolicyOracle::likeliest(const std::vector<std::vector<double>>& values) const {
  std::vector<double> actions;
  if (content_.continuous) actions = values[content_.continuous->mean];
  for (const PolicyDiscreteAction& action : content_.discrete) {
    const std::vector<double>& logits = values[action.logits];
    const auto best = std::ranges::max_element(logits) - logits.begin();
    actions.push_back(static_cast<double>(action.values[static_cast<std::size_t>(best)]));
  }
  return actions;
}

}  // namespace galactic::test
