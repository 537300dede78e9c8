#include "policy/layer_shapes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "check/offence.h"
#include "galactic/schema/pack_generated.h"

namespace galactic::policy {
namespace {

using Floats = flatbuffers::Vector<float>;
using detail::Offence;

constexpr std::uint32_t kMostLayers = 4096;
constexpr std::uint32_t kLargestEdge = 4096;
constexpr std::uint32_t kLargestState = 65536;

/// Number of places of a kernel along an edge; 0 if it does not fit.
std::uint32_t places(std::uint32_t edge, std::uint32_t kernel, std::uint32_t stride,
                     std::uint32_t padding) {
  const std::uint64_t padded = std::uint64_t{edge} + 2 * std::uint64_t{padding};
  return padded < kernel ? 0 : static_cast<std::uint32_t>((padded - kernel) / stride) + 1;
}

std::uint64_t padded(std::uint64_t outputs) { return (outputs + kBlock - 1) / kBlock * kBlock; }

/// Walks through the layers. For each kind of layer, one function returns the shape of its value,
/// given the shapes of its inputs; after an offence, shapes are meaningless.
class ShapeWalk {
 public:
  ShapeWalk(const schema::Policy& policy, const std::string& where)
      : policy_(policy), offence_(where) {}

  Result<std::vector<LayerShape>> run() {
    const auto& layers = *policy_.layers();
    offence_.require(layers.size() >= 1 && layers.size() <= kMostLayers, "layers",
                     "has {} elements, expected 1 to {}", layers.size(), kMostLayers);
    for (flatbuffers::uoffset_t n = 0; n < layers.size() && !offence_.found(); ++n) {
      walk(*layers.Get(n), n);
    }
    if (offence_.found()) return tl::unexpected<Error>(offence_.result().error());
    return std::move(shapes_);
  }

 private:
  void walk(const schema::PolicyLayer& layer, std::uint32_t number) {
    field_ = fmt::format("layers[{}]", number);
    inputs_.clear();
    for (flatbuffers::uoffset_t n = 0; n < layer.inputs()->size(); ++n) {
      const std::uint32_t input = layer.inputs()->Get(n);
      offence_.require(input < number, fmt::format("{}.inputs[{}]", field_, n),
                       "is {}, expected the number of a layer before this one", input);
      if (offence_.found()) return;
      inputs_.push_back(shapes_[input]);
    }
    const LayerShape shape = shapeOf(layer);
    if (offence_.found()) return;
    values_ += shape.size();
    offence_.require(
        values_ <= kMostValues, field_,
        "has a value of {} elements, and all layers up to it have {}, expected at most "
        "{}",
        shape.size(), values_, kMostValues);
    offence_.require(weights_ <= kMostWeights, field_,
                     "brings the weights, padded, to {}, expected at most {}", weights_,
                     kMostWeights);
    offence_.require(products_ <= static_cast<double>(kMostProducts), field_,
                     "brings the multiplications to {}, expected at most {}", products_,
                     kMostProducts);
    shapes_.push_back(shape);
  }

  LayerShape shapeOf(const schema::PolicyLayer& layer) {
    using schema::LayerKind;
    const schema::LayerKind kind = layer.kind_type();
    if (!requireInputs(kind)) return {};
    switch (kind) {
      case LayerKind::ObservationLayer:
        return observation();
      case LayerKind::PreviousActionLayer:
        return previousAction();
      case LayerKind::ImageLayer:
        return image();
      case LayerKind::ConstantLayer:
        return constant(*layer.kind_as_ConstantLayer());
      case LayerKind::NormalizeLayer:
        return normalize(*layer.kind_as_NormalizeLayer());
      case LayerKind::LinearLayer:
        return linear(*layer.kind_as_LinearLayer());
      case LayerKind::ConvolutionLayer:
        return convolution(*layer.kind_as_ConvolutionLayer());
      case LayerKind::GroupNormLayer:
        return groupNorm(*layer.kind_as_GroupNormLayer());
      case LayerKind::LayerNormLayer:
        return layerNorm(*layer.kind_as_LayerNormLayer());
      case LayerKind::ReluLayer:
      case LayerKind::TanhLayer:
        return inputs_[0];
      case LayerKind::ClampLayer:
        return clamp(*layer.kind_as_ClampLayer());
      case LayerKind::SpaceToDepthLayer:
        return spaceToDepth(*layer.kind_as_SpaceToDepthLayer());
      case LayerKind::AveragePoolLayer:
        return averagePool(*layer.kind_as_AveragePoolLayer());
      case LayerKind::SumLayer:
        return sum();
      case LayerKind::ConcatenateLayer:
        return concatenate();
      case LayerKind::SliceLayer:
        return slice(*layer.kind_as_SliceLayer());
      case LayerKind::GruLayer:
        return gru(*layer.kind_as_GruLayer());
      case LayerKind::NONE:
        break;
    }
    return {};
  }

  /// Whether the kind is known and has the inputs that it needs.
  bool requireInputs(schema::LayerKind kind) {
    using schema::LayerKind;
    offence_.require(kind > LayerKind::NONE && kind <= LayerKind::MAX, field_ + ".kind",
                     "is {}, expected 1 to {}; it may come from a later version",
                     static_cast<unsigned>(kind), static_cast<unsigned>(LayerKind::MAX));
    if (offence_.found()) return false;
    std::size_t least = 1;
    std::size_t most = 1;
    if (kind <= LayerKind::ConstantLayer) least = most = 0;
    if (kind == LayerKind::SumLayer) least = most = 2;
    if (kind == LayerKind::ConcatenateLayer) most = kMostLayers;
    offence_.require(inputs_.size() >= least && inputs_.size() <= most, field_ + ".inputs",
                     "has {} elements, expected {}{} for {}", inputs_.size(), least,
                     most > least ? " or more" : "", schema::EnumNameLayerKind(kind));
    return !offence_.found();
  }

  LayerShape observation() {
    std::uint64_t size = 0;
    for (const schema::PolicyObservation* part : *policy_.observation()) size += part->size();
    offence_.require(size >= 1 && size <= kMostValues, field_,
                     "reads an observation of {} elements, expected 1 to {}", size, kMostValues);
    return {.channels = static_cast<std::uint32_t>(size)};
  }

  LayerShape previousAction() {
    std::uint64_t size = policy_.discrete()->size();
    if (policy_.continuous() != nullptr) size += policy_.continuous()->count();
    offence_.require(size >= 1 && size <= kMostValues, field_,
                     "reads {} previous actions, expected 1 to {}", size, kMostValues);
    return {.channels = static_cast<std::uint32_t>(size)};
  }

  LayerShape image() {
    const schema::PolicyImage* image = policy_.image();
    offence_.require(image != nullptr, field_,
                     "reads an image, expected Policy.image to say which");
    if (image == nullptr) return {};
    return {.channels = (image->color() ? 3U : 0U) + (image->depth() ? 1U : 0U),
            .height = image->height(),
            .width = image->width()};
  }

  LayerShape constant(const schema::ConstantLayer& layer) {
    offence_.require(layer.values()->size() >= 1, field_ + ".values",
                     "is empty, expected at least one number");
    requireWeights(layer.values(), "values", layer.values()->size());
    return {.channels = layer.values()->size()};
  }

  LayerShape normalize(const schema::NormalizeLayer& layer) {
    const LayerShape& input = inputs_[0];
    requireWeights(layer.mean(), "mean", input.channels);
    requireWeights(layer.inverse_deviation(), "inverse_deviation", input.channels);
    offence_.require(std::isfinite(layer.limit()) && layer.limit() > 0, field_ + ".limit",
                     "is {}, expected a finite number above 0", layer.limit());
    return input;
  }

  LayerShape linear(const schema::LinearLayer& layer) {
    requireOutputs(layer.outputs());
    requireWeights(layer.weight(), "weight", layer.outputs() * inputs_[0].size());
    if (layer.bias() != nullptr) requireWeights(layer.bias(), "bias", layer.outputs());
    count(layer.outputs(), inputs_[0].size(), 1);
    return {.channels = layer.outputs()};
  }

  LayerShape convolution(const schema::ConvolutionLayer& layer) {
    requireOutputs(layer.outputs());
    const LayerShape shape = slide(layer, layer.outputs());
    if (offence_.found()) return {};
    const std::uint64_t terms =
        std::uint64_t{layer.kernel()} * layer.kernel() * inputs_[0].channels;
    offence_.require(
        terms <= kMostWeights, field_ + ".kernel",
        "is {}, and {} numbers of the input decide one of the result, expected at most "
        "{}",
        layer.kernel(), terms, kMostWeights);
    requireWeights(layer.weight(), "weight", layer.outputs() * terms);
    if (layer.bias() != nullptr) requireWeights(layer.bias(), "bias", layer.outputs());
    count(layer.outputs(), terms, shape.pixels());
    return shape;
  }

  LayerShape averagePool(const schema::AveragePoolLayer& layer) {
    const LayerShape shape = slide(layer, inputs_[0].channels);
    products_ += static_cast<double>(shape.size()) * std::pow(layer.kernel(), 2);
    return shape;
  }

  /// The shape of what a kernel that slides over an image computes.
  template <class Layer>
  LayerShape slide(const Layer& layer, std::uint32_t channels) {
    const LayerShape& input = inputs_[0];
    const std::uint32_t kernel = layer.kernel();
    offence_.require(kernel >= 1 && kernel <= kLargestEdge, field_ + ".kernel",
                     "is {}, expected 1 to {}", kernel, kLargestEdge);
    offence_.require(layer.stride() >= 1, field_ + ".stride", "is 0, expected at least 1");
    offence_.require(layer.padding() < kernel, field_ + ".padding",
                     "is {}, expected less than the kernel of {}", layer.padding(), kernel);
    if (offence_.found()) return {};
    const LayerShape shape{channels, places(input.height, kernel, layer.stride(), layer.padding()),
                           places(input.width, kernel, layer.stride(), layer.padding())};
    offence_.require(shape.height >= 1 && shape.width >= 1, field_ + ".kernel",
                     "is {} and finds no place on {} x {} pixels", kernel, input.width,
                     input.height);
    // The zero padding is stored, too.
    const std::uint64_t edge = 2 * std::uint64_t{layer.padding()};
    if (edge > 0) values_ += (input.height + edge) * (input.width + edge) * input.channels;
    return shape;
  }

  LayerShape groupNorm(const schema::GroupNormLayer& layer) {
    const LayerShape& input = inputs_[0];
    const bool divides = layer.groups() >= 1 && input.channels % layer.groups() == 0;
    offence_.require(divides, field_ + ".groups", "is {}, expected a divisor of the {} channels",
                     layer.groups(), input.channels);
    requireNorm(layer, input.channels);
    return input;
  }

  LayerShape layerNorm(const schema::LayerNormLayer& layer) {
    requireVector(0);
    requireNorm(layer, inputs_[0].channels);
    return inputs_[0];
  }

  template <class Layer>
  void requireNorm(const Layer& layer, std::uint32_t channels) {
    offence_.require(std::isfinite(layer.epsilon()) && layer.epsilon() > 0, field_ + ".epsilon",
                     "is {}, expected a finite number above 0", layer.epsilon());
    requireWeights(layer.weight(), "weight", channels);
    requireWeights(layer.bias(), "bias", channels);
  }

  LayerShape clamp(const schema::ClampLayer& layer) {
    const bool is_range = std::isfinite(layer.lower()) && std::isfinite(layer.upper()) &&
                          layer.lower() <= layer.upper();
    offence_.require(is_range, field_ + ".upper",
                     "and lower are {} and {}, expected finite numbers, lower the smaller",
                     layer.upper(), layer.lower());
    return inputs_[0];
  }

  LayerShape spaceToDepth(const schema::SpaceToDepthLayer& layer) {
    const LayerShape& input = inputs_[0];
    const std::uint32_t block = layer.block();
    const bool divides = block >= 1 && input.height % block == 0 && input.width % block == 0;
    offence_.require(divides, field_ + ".block", "is {}, expected a divisor of {} x {} pixels",
                     block, input.width, input.height);
    if (!divides) return {};
    // At most kMostValues: the value has as many elements as its input.
    return {input.channels * block * block, input.height / block, input.width / block};
  }

  LayerShape sum() {
    offence_.require(inputs_[0] == inputs_[1], field_ + ".inputs",
                     "have {} x {} x {} and {} x {} x {} elements, expected the same shape",
                     inputs_[0].channels, inputs_[0].height, inputs_[0].width, inputs_[1].channels,
                     inputs_[1].height, inputs_[1].width);
    return inputs_[0];
  }

  LayerShape concatenate() {
    std::uint64_t size = 0;
    for (std::size_t n = 0; n < inputs_.size(); ++n) {
      requireVector(n);
      size += inputs_[n].size();
    }
    offence_.require(size <= kMostValues, field_, "has {} elements, expected at most {}", size,
                     kMostValues);
    return {.channels = static_cast<std::uint32_t>(size)};
  }

  LayerShape slice(const schema::SliceLayer& layer) {
    requireVector(0);
    const std::uint64_t end = std::uint64_t{layer.first()} + layer.size();
    offence_.require(layer.size() >= 1 && end <= inputs_[0].channels, field_ + ".size",
                     "is {} from element {} on, expected 1 or more of the {} elements",
                     layer.size(), layer.first(), inputs_[0].channels);
    return {.channels = layer.size()};
  }

  LayerShape gru(const schema::GruLayer& layer) {
    requireVector(0);
    const std::uint64_t size = layer.size();
    offence_.require(size >= 1 && size <= kLargestState, field_ + ".size",
                     "is {}, expected 1 to {}", size, kLargestState);
    requireWeights(layer.input_weight(), "input_weight", 3 * size * inputs_[0].size());
    requireWeights(layer.state_weight(), "state_weight", 3 * size * size);
    requireWeights(layer.input_bias(), "input_bias", 3 * size);
    requireWeights(layer.state_bias(), "state_bias", 3 * size);
    count(3 * size, inputs_[0].size(), 1);
    count(3 * size, size, 1);
    // The gates have two sums each, of the input and of the state, and both are stored.
    values_ += 6 * size;
    return {.channels = layer.size()};
  }

  void requireVector(std::size_t input) {
    offence_.require(inputs_[input].isVector(), fmt::format("{}.inputs[{}]", field_, input),
                     "has {} x {} pixels, expected a vector", inputs_[input].width,
                     inputs_[input].height);
  }

  void requireOutputs(std::uint32_t outputs) {
    offence_.require(outputs >= 1 && outputs <= kMostValues, field_ + ".outputs",
                     "is {}, expected 1 to {}", outputs, kMostValues);
  }

  void requireWeights(const Floats* weights, const char* name, std::uint64_t wanted) {
    offence_.require(weights->size() == wanted, fmt::format("{}.{}", field_, name),
                     "has {} elements, expected {}", weights->size(), wanted);
    if (offence_.found()) return;
    const auto broken =
        std::find_if(weights->begin(), weights->end(), [](float w) { return !std::isfinite(w); });
    offence_.require(broken == weights->end(),
                     fmt::format("{}.{}[{}]", field_, name, broken - weights->begin()),
                     "is not finite, expected a number");
  }

  void count(std::uint64_t outputs, std::uint64_t terms, std::uint64_t pixels) {
    if (offence_.found()) return;
    weights_ += padded(outputs) * terms;
    products_ += static_cast<double>(padded(outputs) * terms) * static_cast<double>(pixels);
  }

  const schema::Policy& policy_;
  Offence offence_;
  std::vector<LayerShape> shapes_;
  /// The path of the current layer in messages.
  std::string field_;
  std::vector<LayerShape> inputs_;
  std::uint64_t values_ = 0;
  std::uint64_t weights_ = 0;
  double products_ = 0;
};

}  // namespace

Result<std::vector<LayerShape>> layerShapes(const schema::Policy& policy,
                                            const std::string& where) {
  return ShapeWalk(policy, where).run();
}

}  // namespace galactic::policy
