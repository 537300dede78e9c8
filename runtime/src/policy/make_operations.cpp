#include <array>
#include <utility>

#include "galactic/schema/pack_generated.h"
#include "policy/element_operations.h"
#include "policy/image_operations.h"
#include "policy/input_operations.h"
#include "policy/operation.h"
#include "policy/packed_product.h"
#include "policy/product_operations.h"

namespace galactic::policy {
namespace {

using Floats = flatbuffers::Vector<float>;

void setBias(PackedProduct& product, const Floats* bias) {
  if (bias == nullptr) return;
  for (flatbuffers::uoffset_t n = 0; n < bias->size(); ++n) product.setBias(n, bias->Get(n));
}

/// Sets the weights from `outputs` rows, placing term t of each row at `term_of(t)`.
template <class TermOf>
void setWeights(PackedProduct& product, const Floats& weights, const TermOf& term_of) {
  const std::size_t terms = weights.size() / product.outputs();
  const float* weight = weights.data();
  for (std::size_t output = 0; output < product.outputs(); ++output) {
    for (std::size_t t = 0; t < terms; ++t) product.setWeight(output, term_of(t), *weight++);
  }
}

/// The product of a layer that takes a vector.
PackedProduct plainProduct(std::size_t outputs, const Floats& weights, const Floats* bias) {
  PackedProduct product(outputs, {.run_length = weights.size() / outputs});
  setWeights(product, weights, [](std::size_t t) { return t; });
  setBias(product, bias);
  return product;
}

/// Makes the operations layer by layer.
class OperationMaker {
 public:
  OperationMaker(const schema::Policy& policy, std::span<const LayerShape> shapes,
                 std::span<const ObservationRange> observation)
      : policy_(policy), shapes_(shapes), observation_(observation) {}

  OperationList make(std::span<const std::uint32_t> kept) {
    for (flatbuffers::uoffset_t n = 0; n < policy_.layers()->size(); ++n) {
      number_ = n;
      layer_ = policy_.layers()->Get(n);
      list_.values.push_back(makeLayer());
    }
    for (const std::uint32_t layer : kept) list_.plan.read(list_.values[layer], now());
    list_.plan.place();
    return std::move(list_);
  }

 private:
  [[nodiscard]] std::size_t now() const { return list_.operations.size(); }
  [[nodiscard]] const LayerShape& shape() const { return shapes_[number_]; }
  [[nodiscard]] const LayerShape& inputShape(flatbuffers::uoffset_t n) const {
    return shapes_[layer_->inputs()->Get(n)];
  }
  /// The buffer of an input; records that the next operation reads it.
  BufferId input(flatbuffers::uoffset_t n = 0) {
    const BufferId buffer = list_.values[layer_->inputs()->Get(n)];
    list_.plan.read(buffer, now());
    return buffer;
  }
  BufferId fresh() { return list_.plan.add(shape().size(), now()); }
  template <class Made, class... Args>
  void push(Args&&... args) {
    list_.operations.push_back(std::make_unique<Made>(std::forward<Args>(args)...));
  }

  BufferId makeLayer() {
    using schema::LayerKind;
    switch (layer_->kind_type()) {
      case LayerKind::ObservationLayer:
        return source<ObservationOperation>(observation_);
      case LayerKind::PreviousActionLayer:
        return source<PreviousActionOperation>();
      case LayerKind::ImageLayer:
        return source<ImageOperation>(*policy_.image());
      case LayerKind::ConstantLayer:
        return source<ConstantOperation>(*layer_->kind_as_ConstantLayer()->values());
      case LayerKind::NormalizeLayer:
        return inPlace<NormalizeOperation>(*layer_->kind_as_NormalizeLayer());
      case LayerKind::ClampLayer:
        return inPlace<ClampOperation>(*layer_->kind_as_ClampLayer());
      case LayerKind::ReluLayer:
        return inPlace<ElementOperation>(&Kernels::relu);
      case LayerKind::TanhLayer:
        return inPlace<ElementOperation>(&Kernels::tanh);
      case LayerKind::LinearLayer:
        return linear(*layer_->kind_as_LinearLayer());
      case LayerKind::ConvolutionLayer:
        return convolution(*layer_->kind_as_ConvolutionLayer());
      case LayerKind::GroupNormLayer:
        return norm(*layer_->kind_as_GroupNormLayer(), layer_->kind_as_GroupNormLayer()->groups());
      case LayerKind::LayerNormLayer:
        return norm(*layer_->kind_as_LayerNormLayer(), 1);
      case LayerKind::SpaceToDepthLayer:
        return spaceToDepth(layer_->kind_as_SpaceToDepthLayer()->block());
      case LayerKind::AveragePoolLayer:
        return averagePool(*layer_->kind_as_AveragePoolLayer());
      case LayerKind::SumLayer:
        return sum();
      case LayerKind::ConcatenateLayer:
        return concatenate();
      case LayerKind::SliceLayer:
        return slice(*layer_->kind_as_SliceLayer());
      case LayerKind::GruLayer:
        return gru(*layer_->kind_as_GruLayer());
      case LayerKind::NONE:
        break;
    }
    return {};
  }

  /// Adds a layer without inputs.
  template <class Made, class... Args>
  BufferId source(Args&&... args) {
    const BufferId to = fresh();
    push<Made>(to, std::forward<Args>(args)...);
    return to;
  }

  /// Adds a layer that takes its input element by element.
  template <class Made, class... Args>
  BufferId inPlace(Args&&... args) {
    const BufferId from = input();
    const BufferId to = list_.plan.addLike(from, now());
    push<Made>(from, to, shape(), std::forward<Args>(args)...);
    return to;
  }

  BufferId linear(const schema::LinearLayer& layer) {
    const LayerShape& from_shape = inputShape(0);
    PackedProduct product(layer.outputs(), {.run_length = from_shape.size()});
    // Weights are stored channel by channel, values pixel by pixel.
    const std::size_t pixels = from_shape.pixels();
    const std::size_t channels = from_shape.channels;
    setWeights(product, *layer.weight(),
               [=](std::size_t t) { return t % pixels * channels + t / pixels; });
    setBias(product, layer.bias());
    const BufferId from = input();
    const BufferId to = fresh();
    push<ProductOperation>(from, to, std::move(product), Places{from_shape, shape()});
    return to;
  }

  BufferId convolution(const schema::ConvolutionLayer& layer) {
    const auto [from, around] = padded(layer.padding());
    const std::size_t kernel = layer.kernel();
    const std::size_t channels = around.channels;
    PackedProduct product(
        layer.outputs(),
        {.runs = kernel, .run_length = kernel * channels, .run_stride = around.width * channels});
    const std::size_t square = kernel * kernel;
    setWeights(product, *layer.weight(),
               [=](std::size_t t) { return t % square * channels + t / square; });
    setBias(product, layer.bias());
    list_.plan.read(from, now());
    const BufferId to = fresh();
    push<ProductOperation>(from, to, std::move(product), Places{around, shape(), layer.stride()});
    return to;
  }

  BufferId averagePool(const schema::AveragePoolLayer& layer) {
    const auto [from, around] = padded(layer.padding());
    list_.plan.read(from, now());
    const BufferId to = fresh();
    push<AveragePoolOperation>(from, to, Places{around, shape(), layer.stride()}, layer.kernel());
    return to;
  }

  struct Padded {
    BufferId buffer = 0;
    LayerShape shape;
  };
  /// The input with zeros around it.
  Padded padded(std::uint32_t padding) {
    const LayerShape& inside = inputShape(0);
    if (padding == 0) return {input(), inside};
    const LayerShape around{inside.channels, inside.height + 2 * padding,
                            inside.width + 2 * padding};
    const BufferId from = input();
    const BufferId to = list_.plan.add(around.size(), now());
    push<PadOperation>(from, to, inside, padding);
    return {to, around};
  }

  template <class Layer>
  BufferId norm(const Layer& layer, std::size_t groups) {
    const BufferId scratch = list_.plan.add(2 * std::size_t{shape().channels}, now());
    const BufferId from = input();
    const BufferId to = list_.plan.addLike(from, now());
    push<NormOperation>(from, to, scratch, shape(), layer, groups);
    return to;
  }

  BufferId spaceToDepth(std::uint32_t block) {
    const BufferId from = input();
    const BufferId to = fresh();
    push<SpaceToDepthOperation>(from, to, inputShape(0), block);
    return to;
  }

  BufferId sum() {
    const std::array from{input(0), input(1)};
    const BufferId to = list_.plan.addLike(from[0], now());
    push<SumOperation>(from, to, shape());
    return to;
  }

  BufferId concatenate() {
    std::vector<ConcatenateOperation::Part> parts;
    for (flatbuffers::uoffset_t n = 0; n < layer_->inputs()->size(); ++n) {
      parts.push_back({.from = input(n), .size = inputShape(n).size()});
    }
    const BufferId to = fresh();
    push<ConcatenateOperation>(std::move(parts), to);
    return to;
  }

  BufferId slice(const schema::SliceLayer& layer) {
    const BufferId from = input();
    const BufferId to = fresh();
    push<SliceOperation>(from, to, layer);
    return to;
  }

  BufferId gru(const schema::GruLayer& layer) {
    const std::size_t size = layer.size();
    GruBuffers buffers;
    buffers.from = input();
    buffers.input_sums = list_.plan.add(3 * size, now());
    buffers.state_sums = list_.plan.add(3 * size, now());
    buffers.to = fresh();
    buffers.state = list_.state_size;
    list_.state_size += (size + kLane - 1) / kLane * kLane;
    push<GruOperation>(buffers, plainProduct(3 * size, *layer.input_weight(), layer.input_bias()),
                       plainProduct(3 * size, *layer.state_weight(), layer.state_bias()));
    return buffers.to;
  }

  const schema::Policy& policy_;
  std::span<const LayerShape> shapes_;
  std::span<const ObservationRange> observation_;
  OperationList list_;
  /// The current layer.
  std::uint32_t number_ = 0;
  const schema::PolicyLayer* layer_ = nullptr;
};

}  // namespace

OperationList makeOperations(const schema::Policy& policy, std::span<const LayerShape> shapes,
                             std::span<const ObservationRange> observation,
                             std::span<const std::uint32_t> kept) {
  return OperationMaker(policy, shapes, observation).make(kept);
}

}  // namespace galactic::policy
