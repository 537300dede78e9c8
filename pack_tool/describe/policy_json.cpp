#include <array>
#include <cstdint>
#include <string>

#include "pack_tool/describe/asset_json.h"
#include "pack_tool/describe/json_parts.h"

namespace galactic::pack_tool {

namespace {

using Floats = flatbuffers::Vector<float>;

/// How many weights, and a hash of them; null where there are none.
Json describeWeights(const Floats* weights) {
  if (weights == nullptr) return nullptr;
  const std::span<const float> values(weights->data(), weights->size());
  return {{"count", values.size()}, {"hash", contentHash(std::as_bytes(values))}};
}

Json describeNumbers(const Floats& numbers) {
  Json list = Json::array();
  for (const float number : numbers) list.push_back(jsonNumber(number));
  return list;
}

/// What a layer has beside its inputs.
Json describeKind(const schema::PolicyLayer& layer) {
  Json json = Json::object();
  if (const auto* constant = layer.kind_as_ConstantLayer()) {
    json["values"] = describeWeights(constant->values());
  } else if (const auto* normalize = layer.kind_as_NormalizeLayer()) {
    json["limit"] = jsonNumber(normalize->limit());
    json["mean"] = describeWeights(normalize->mean());
    json["inverse_deviation"] = describeWeights(normalize->inverse_deviation());
  } else if (const auto* linear = layer.kind_as_LinearLayer()) {
    json["outputs"] = linear->outputs();
    json["weight"] = describeWeights(linear->weight());
    json["bias"] = describeWeights(linear->bias());
  } else if (const auto* convolution = layer.kind_as_ConvolutionLayer()) {
    json["outputs"] = convolution->outputs();
    json["kernel"] = convolution->kernel();
    json["stride"] = convolution->stride();
    json["padding"] = convolution->padding();
    json["weight"] = describeWeights(convolution->weight());
    json["bias"] = describeWeights(convolution->bias());
  } else if (const auto* group_norm = layer.kind_as_GroupNormLayer()) {
    json["groups"] = group_norm->groups();
    json["epsilon"] = jsonNumber(group_norm->epsilon());
    json["weight"] = describeWeights(group_norm->weight());
    json["bias"] = describeWeights(group_norm->bias());
  } else if (const auto* layer_norm = layer.kind_as_LayerNormLayer()) {
    json["epsilon"] = jsonNumber(layer_norm->epsilon());
    json["weight"] = describeWeights(layer_norm->weight());
    json["bias"] = describeWeights(layer_norm->bias());
  } else if (const auto* clamp = layer.kind_as_ClampLayer()) {
    json["lower"] = jsonNumber(clamp->lower());
    json["upper"] = jsonNumber(clamp->upper());
  } else if (const auto* space_to_depth = layer.kind_as_SpaceToDepthLayer()) {
    json["block"] = space_to_depth->block();
  } else if (const auto* pool = layer.kind_as_AveragePoolLayer()) {
    json["kernel"] = pool->kernel();
    json["stride"] = pool->stride();
    json["padding"] = pool->padding();
  } else if (const auto* slice = layer.kind_as_SliceLayer()) {
    json["first"] = slice->first();
    json["size"] = slice->size();
  } else if (const auto* gru = layer.kind_as_GruLayer()) {
    json["size"] = gru->size();
    json["input_weight"] = describeWeights(gru->input_weight());
    json["state_weight"] = describeWeights(gru->state_weight());
    json["input_bias"] = describeWeights(gru->input_bias());
    json["state_bias"] = describeWeights(gru->state_bias());
  }
  return json;
}

Json describeLayer(const schema::PolicyLayer& layer) {
  Json json;
  std::string kind = schema::EnumNameLayerKind(layer.kind_type());
  constexpr std::string_view kSuffix = "Layer";
  if (kind.ends_with(kSuffix)) kind.resize(kind.size() - kSuffix.size());
  json["kind"] = kind;
  json["inputs"] = Json::array();
  for (const std::uint32_t input : *layer.inputs()) json["inputs"].push_back(input);
  json.update(describeKind(layer));
  return json;
}

Json describeImage(const schema::PolicyImage* image) {
  if (image == nullptr) return nullptr;
  const schema::CameraPlace* place = image->place();
  const schema::CameraPlace by_itself;
  const schema::CameraPlace& at = place == nullptr ? by_itself : *place;
  return {
      {"width", image->width()},
      {"height", image->height()},
      {"color", image->color()},
      {"color_scale", jsonNumber(image->color_scale())},
      {"depth", image->depth()},
      {"depth_limit", jsonNumber(image->depth_limit())},
      {"depth_scale", jsonNumber(image->depth_scale())},
      {"camera", image->camera()->str()},
      {"vertical_fov", jsonNumber(image->vertical_fov())},
      {"position",
       Json::array({jsonNumber(at.ahead()), jsonNumber(at.left()), jsonNumber(at.up())})},
      {"rpy_degrees", Json::array({jsonNumber(at.roll_degrees()), jsonNumber(at.pitch_degrees()),
                                   jsonNumber(at.yaw_degrees())})},
      {"near", jsonNumber(image->near())}};
}

/// All weights of the layers, as their descriptions count them.
std::uint64_t weightsIn(const Json& layers) {
  std::uint64_t count = 0;
  for (const Json& layer : layers) {
    for (const Json& field : layer) {
      if (field.is_object() && field.contains("count")) {
        count += field.at("count").get<std::uint64_t>();
      }
    }
  }
  return count;
}

}  // namespace

Json describePolicy(const PackFile& pack) {
  const schema::Policy* policy = pack.root().asset_as_Policy();
  if (policy == nullptr) return nullptr;
  Json json;
  json["name"] = policy->name()->str();
  json["robot"] = policy->robot()->str();
  json["options"] = Json::array();
  for (const schema::Option* one : *policy->options()) {
    json["options"].push_back({{"name", one->name()->str()}, {"value", one->value()->str()}});
  }
  json["observation"] = Json::array();
  for (const schema::PolicyObservation* part : *policy->observation()) {
    json["observation"].push_back({{"name", part->name()->str()}, {"size", part->size()}});
  }
  json["image"] = describeImage(policy->image());
  json["layers"] = Json::array();
  for (const schema::PolicyLayer* layer : *policy->layers()) {
    json["layers"].push_back(describeLayer(*layer));
  }
  json["weights"] = weightsIn(json["layers"]);
  json["continuous"] = nullptr;
  if (const schema::ContinuousActions* continuous = policy->continuous()) {
    json["continuous"] = {{"count", continuous->count()},
                          {"mean", continuous->mean()},
                          {"log_deviation", continuous->log_deviation()}};
  }
  json["discrete"] = Json::array();
  for (const schema::DiscreteAction* action : *policy->discrete()) {
    json["discrete"].push_back(
        {{"logits", action->logits()}, {"values", describeNumbers(*action->values())}});
  }
  return json;
}

}  // namespace galactic::pack_tool
