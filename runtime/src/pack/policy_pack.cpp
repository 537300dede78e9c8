#include "galactic/policy_pack.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <new>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "check/pack_check.h"
#include "galactic/schema/pack_generated.h"
#include "pack/schema_values.h"
#include "support/content_hash.h"
#include "support/files/atomic_file.h"
#include "support/try.h"

namespace galactic {
namespace {

using Builder = flatbuffers::FlatBufferBuilder;
using flatbuffers::Offset;
using FloatVector = Offset<flatbuffers::Vector<float>>;
using OptionVector = Offset<flatbuffers::Vector<Offset<schema::Option>>>;

constexpr std::size_t kVectorAlignment = 32;

FloatVector floats(Builder& builder, const std::vector<float>& values) {
  builder.ForceVectorAlignment(values.size(), sizeof(float), kVectorAlignment);
  return builder.CreateVector(values);
}

/// An empty offset if there are no values.
FloatVector optionalFloats(Builder& builder, const std::vector<float>& values) {
  return values.empty() ? FloatVector() : floats(builder, values);
}

OptionVector optionVector(Builder& builder, const std::vector<OptionText>& options) {
  std::vector<Offset<schema::Option>> stored;
  for (const OptionText& option : options) {
    const auto name = builder.CreateString(option.name);
    const auto value = builder.CreateString(option.value);
    stored.push_back(schema::CreateOption(builder, name, value));
  }
  return builder.CreateVector(stored);
}

/// Writes the table of a layer's kind.
class KindWriter {
 public:
  using Kind = std::pair<schema::LayerKind, Offset<void>>;

  explicit KindWriter(Builder& builder) : builder_(builder) {}

  Kind operator()(const layer::Observation&) {
    return {schema::LayerKind::ObservationLayer, schema::CreateObservationLayer(builder_).Union()};
  }
  Kind operator()(const layer::PreviousAction&) {
    return {schema::LayerKind::PreviousActionLayer,
            schema::CreatePreviousActionLayer(builder_).Union()};
  }
  Kind operator()(const layer::Image&) {
    return {schema::LayerKind::ImageLayer, schema::CreateImageLayer(builder_).Union()};
  }
  Kind operator()(const layer::Constant& kind) {
    const auto values = floats(builder_, kind.values);
    return {schema::LayerKind::ConstantLayer,
            schema::CreateConstantLayer(builder_, values).Union()};
  }
  Kind operator()(const layer::Normalize& kind) {
    const auto mean = floats(builder_, kind.mean);
    const auto inverse_deviation = floats(builder_, kind.inverse_deviation);
    return {schema::LayerKind::NormalizeLayer,
            schema::CreateNormalizeLayer(builder_, mean, inverse_deviation, kind.limit).Union()};
  }
  Kind operator()(const layer::Linear& kind) {
    const auto weight = floats(builder_, kind.weight);
    const auto bias = optionalFloats(builder_, kind.bias);
    return {schema::LayerKind::LinearLayer,
            schema::CreateLinearLayer(builder_, kind.outputs, weight, bias).Union()};
  }
  Kind operator()(const layer::Convolution& kind) {
    const auto weight = floats(builder_, kind.weight);
    const auto bias = optionalFloats(builder_, kind.bias);
    return {schema::LayerKind::ConvolutionLayer,
            schema::CreateConvolutionLayer(builder_, kind.outputs, kind.kernel, kind.stride,
                                           kind.padding, weight, bias)
                .Union()};
  }
  Kind operator()(const layer::GroupNorm& kind) {
    const auto weight = floats(builder_, kind.weight);
    const auto bias = floats(builder_, kind.bias);
    return {
        schema::LayerKind::GroupNormLayer,
        schema::CreateGroupNormLayer(builder_, kind.groups, kind.epsilon, weight, bias).Union()};
  }
  Kind operator()(const layer::LayerNorm& kind) {
    const auto weight = floats(builder_, kind.weight);
    const auto bias = floats(builder_, kind.bias);
    return {schema::LayerKind::LayerNormLayer,
            schema::CreateLayerNormLayer(builder_, kind.epsilon, weight, bias).Union()};
  }
  Kind operator()(const layer::Relu&) {
    return {schema::LayerKind::ReluLayer, schema::CreateReluLayer(builder_).Union()};
  }
  Kind operator()(const layer::Tanh&) {
    return {schema::LayerKind::TanhLayer, schema::CreateTanhLayer(builder_).Union()};
  }
  Kind operator()(const layer::Clamp& kind) {
    return {schema::LayerKind::ClampLayer,
            schema::CreateClampLayer(builder_, kind.lower, kind.upper).Union()};
  }
  Kind operator()(const layer::SpaceToDepth& kind) {
    return {schema::LayerKind::SpaceToDepthLayer,
            schema::CreateSpaceToDepthLayer(builder_, kind.block).Union()};
  }
  Kind operator()(const layer::AveragePool& kind) {
    return {
        schema::LayerKind::AveragePoolLayer,
        schema::CreateAveragePoolLayer(builder_, kind.kernel, kind.stride, kind.padding).Union()};
  }
  Kind operator()(const layer::Sum&) {
    return {schema::LayerKind::SumLayer, schema::CreateSumLayer(builder_).Union()};
  }
  Kind operator()(const layer::Concatenate&) {
    return {schema::LayerKind::ConcatenateLayer, schema::CreateConcatenateLayer(builder_).Union()};
  }
  Kind operator()(const layer::Slice& kind) {
    return {schema::LayerKind::SliceLayer,
            schema::CreateSliceLayer(builder_, kind.first, kind.size).Union()};
  }
  Kind operator()(const layer::Gru& kind) {
    const auto input_weight = floats(builder_, kind.input_weight);
    const auto state_weight = floats(builder_, kind.state_weight);
    const auto input_bias = floats(builder_, kind.input_bias);
    const auto state_bias = floats(builder_, kind.state_bias);
    return {schema::LayerKind::GruLayer,
            schema::CreateGruLayer(builder_, kind.size, input_weight, state_weight, input_bias,
                                   state_bias)
                .Union()};
  }

 private:
  Builder& builder_;
};

auto layerVector(Builder& builder, const std::vector<PolicyLayer>& layers) {
  std::vector<Offset<schema::PolicyLayer>> stored;
  for (const PolicyLayer& one : layers) {
    const auto inputs = builder.CreateVector(one.inputs);
    const auto [type, kind] = std::visit(KindWriter(builder), one.kind);
    stored.push_back(schema::CreatePolicyLayer(builder, inputs, type, kind));
  }
  return builder.CreateVector(stored);
}

/// None if the image uses the camera's own place.
std::optional<schema::CameraPlace> placeOf(const PolicyImage& image) {
  constexpr std::array<float, 3> kZeros{};
  if (image.position == kZeros && image.rpy_degrees == kZeros) return {};
  const auto& [ahead, left, up] = image.position;
  const auto& [roll, pitch, yaw] = image.rpy_degrees;
  return schema::CameraPlace(ahead, left, up, roll, pitch, yaw);
}

Offset<schema::PolicyImage> imageTable(Builder& builder, const std::optional<PolicyImage>& image) {
  if (!image) return {};
  const auto camera = builder.CreateString(image->camera);
  const auto place = placeOf(*image);
  return schema::CreatePolicyImage(builder, image->width, image->height, image->color,
                                   image->color_scale, image->depth, image->depth_limit,
                                   image->depth_scale, camera, image->vertical_fov,
                                   place ? &*place : nullptr, image->near);
}

Offset<schema::Policy> policyTable(Builder& builder, const PolicyContent& content) {
  const PolicyInterface& needs = content.interface;
  const auto name = builder.CreateString(needs.name);
  const auto robot = builder.CreateString(needs.robot);
  const auto options = optionVector(builder, needs.options);
  std::vector<Offset<schema::PolicyObservation>> parts;
  for (const PolicyPart& part : needs.observation) {
    const auto part_name = builder.CreateString(part.name);
    parts.push_back(schema::CreatePolicyObservation(builder, part_name, part.size));
  }
  const auto observation = builder.CreateVector(parts);
  const auto image = imageTable(builder, needs.image);
  const auto layers = layerVector(builder, content.layers);
  Offset<schema::ContinuousActions> continuous;
  if (content.continuous) {
    continuous = schema::CreateContinuousActions(builder, content.continuous->count,
                                                 content.continuous->mean,
                                                 content.continuous->log_deviation);
  }
  std::vector<Offset<schema::DiscreteAction>> actions;
  for (const PolicyDiscreteAction& action : content.discrete) {
    const auto values = builder.CreateVector(action.values);
    actions.push_back(schema::CreateDiscreteAction(builder, action.logits, values));
  }
  const auto discrete = builder.CreateVector(actions);
  return schema::CreatePolicy(builder, name, robot, options, observation, image, layers, continuous,
                              discrete);
}

Offset<schema::Provenance> provenanceTable(Builder& builder, const PolicyProvenance& provenance) {
  const auto tool = builder.CreateString(provenance.tool);
  const auto version = builder.CreateString(provenance.tool_version);
  const auto options = optionVector(builder, provenance.options);
  std::vector<Offset<schema::SourceFile>> sources;
  if (!provenance.source_name.empty()) {
    const auto name = builder.CreateString(provenance.source_name);
    const detail::ContentHash hash = detail::contentHash(provenance.source);
    const schema::Hash128 stored(hash.low, hash.high);
    sources.push_back(schema::CreateSourceFile(builder, name, provenance.source.size(), &stored));
  }
  const auto source_vector = builder.CreateVector(sources);
  const auto warnings = builder.CreateVector(std::vector<Offset<flatbuffers::String>>{});
  return schema::CreateProvenance(builder, tool, version, options, source_vector, warnings);
}

/// A copy with the alignment that reading in place requires.
class AlignedCopy {
 public:
  explicit AlignedCopy(std::span<const std::byte> bytes)
      : size_(bytes.size()),
        block_(static_cast<std::byte*>(::operator new(bytes.size(), kAlignment))) {
    std::ranges::copy(bytes, block_);
  }
  ~AlignedCopy() { ::operator delete(block_, kAlignment); }
  AlignedCopy(const AlignedCopy&) = delete;
  AlignedCopy& operator=(const AlignedCopy&) = delete;
  AlignedCopy(AlignedCopy&&) = delete;
  AlignedCopy& operator=(AlignedCopy&&) = delete;

  [[nodiscard]] std::span<const std::byte> bytes() const { return {block_, size_}; }

 private:
  static constexpr std::align_val_t kAlignment{64};
  std::size_t size_;
  std::byte* block_;
};

/// About how many bytes the weights take.
std::uint64_t roughSize(const PolicyContent& content) {
  std::uint64_t floats = 0;
  const auto add = [&floats](const auto&... vectors) { ((floats += vectors.size()), ...); };
  for (const PolicyLayer& one : content.layers) {
    if (const auto* linear = std::get_if<layer::Linear>(&one.kind)) add(linear->weight);
    if (const auto* convolution = std::get_if<layer::Convolution>(&one.kind)) {
      add(convolution->weight);
    }
    if (const auto* gru = std::get_if<layer::Gru>(&one.kind)) {
      add(gru->input_weight, gru->state_weight);
    }
  }
  return floats * sizeof(float);
}

}  // namespace

std::vector<std::byte> encodePolicyPack(const PolicyContent& content,
                                        const PolicyProvenance& provenance) {
  Builder builder;
  const auto provenance_table = provenanceTable(builder, provenance);
  const auto policy = policyTable(builder, content);
  schema::FinishPackBuffer(builder, schema::CreatePack(builder, provenance_table,
                                                       schema::Asset::Policy, policy.Union()));
  const std::span payload(reinterpret_cast<const std::byte*>(builder.GetBufferPointer()),
                          builder.GetSize());
  const PackHeader header = makePackHeader(PackKind::kPolicy, payload);
  std::vector<std::byte> file(sizeof(header) + payload.size());
  std::memcpy(file.data(), &header, sizeof(header));
  std::memcpy(file.data() + sizeof(header), payload.data(), payload.size());
  return file;
}

Result<void> writePolicyPack(const std::filesystem::path& path, const PolicyContent& content,
                             const PolicyProvenance& provenance) {
  constexpr std::uint64_t kMostBytes = detail::kMaxPayloadBytes / 2;
  if (const std::uint64_t size = roughSize(content); size > kMostBytes) {
    return fail(
        ErrorCode::kInvalidInput, path.string(),
        fmt::format("would have weights of {} bytes, a policy has at most {}", size, kMostBytes));
  }
  const AlignedCopy file(encodePolicyPack(content, provenance));
  RETURN_IF_ERROR(PackFile::view(file.bytes(), path.string()));
  return writeFileAtomically(path, {file.bytes()});
}

Result<PolicyInterface> policyInterface(const PackFile& pack) {
  const schema::Policy* stored =
      pack.kind() == PackKind::kPolicy ? pack.root().asset_as_Policy() : nullptr;
  if (stored == nullptr) {
    return fail(ErrorCode::kInvalidInput, pack.where(),
                "is a pack of kind " + packKindName(pack.kind()) +
                    ", expected a policy (PLCY); make one with python -m galactic.export");
  }
  PolicyInterface needs;
  needs.name = stored->name()->str();
  needs.robot = stored->robot()->str();
  for (const schema::Option* option : *stored->options()) {
    needs.options.push_back({option->name()->str(), option->value()->str()});
  }
  for (const schema::PolicyObservation* part : *stored->observation()) {
    needs.observation.push_back({part->name()->str(), part->size()});
  }
  if (const schema::PolicyImage* image = stored->image()) {
    needs.image = PolicyImage{.width = image->width(),
                              .height = image->height(),
                              .color = image->color(),
                              .color_scale = image->color_scale(),
                              .depth = image->depth(),
                              .depth_limit = image->depth_limit(),
                              .depth_scale = image->depth_scale(),
                              .camera = image->camera()->str(),
                              .vertical_fov = image->vertical_fov(),
                              .near = image->near()};
    if (const schema::CameraPlace* place = image->place()) {
      needs.image->position = {place->ahead(), place->left(), place->up()};
      needs.image->rpy_degrees = {place->roll_degrees(), place->pitch_degrees(),
                                  place->yaw_degrees()};
    }
  }
  if (stored->continuous() != nullptr) needs.continuous_actions = stored->continuous()->count();
  needs.discrete_actions = stored->discrete()->size();
  return needs;
}

}  // namespace galactic
