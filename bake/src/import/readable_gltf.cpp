#include "import/readable_gltf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <utility>
#include <vector>

#include "import/gltf_accessors.h"
#include "import/gltf_json.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Bytes = std::span<const std::byte>;

constexpr std::uint64_t kTexelCoordinates = 2;
constexpr std::uint64_t kSpaceCoordinates = 3;

/// The object at `pointer` below `parent`; null if there is none.
const Json* objectAt(const Json& parent, const char* pointer) {
  const Json::json_pointer at(pointer);
  if (!parent.contains(at)) return nullptr;
  const Json& found = parent.at(at);
  return found.is_object() ? &found : nullptr;
}

/// The rows of the transform from texture coordinates of the file to those of the image.
using UvTransform = std::array<double, 6>;
constexpr UvTransform kUnmoved{1, 0, 0, 0, 1, 0};

/// How a texture is mapped.
struct Mapping {
  std::uint64_t set = 0;
  UvTransform image_from_uv = kUnmoved;
};

/// The two numbers of the list `key`; `otherwise` if it is not such a list.
std::array<double, 2> pairOf(const Json& object, const char* key,
                             const std::array<double, 2>& otherwise) {
  const auto list = object.find(key);
  const bool is_pair = list != object.end() && list->is_array() && list->size() == 2 &&
                       (*list)[0].is_number() && (*list)[1].is_number();
  if (!is_pair) return otherwise;
  return {(*list)[0].get<double>(), (*list)[1].get<double>()};
}

/// The transform of KHR_texture_transform: scales, then rotates, then moves. Positive angles turn u
/// towards -v, which is up: https://github.com/KhronosGroup/glTF/issues/1563.
UvTransform transformOf(const Json& extension) {
  const auto offset = pairOf(extension, "offset", {0, 0});
  const auto scale = pairOf(extension, "scale", {1, 1});
  const auto rotation = extension.find("rotation");
  const bool turns = rotation != extension.end() && rotation->is_number();
  const double angle = turns ? rotation->get<double>() : 0;
  const double sine = std::sin(angle);
  const double cosine = std::cos(angle);
  return {cosine * scale[0], sine * scale[1],   offset[0],
          -sine * scale[0],  cosine * scale[1], offset[1]};
}

/// The mapping of the texture that a primitive's color comes from.
Mapping mappingOf(const Json& document, const Json& primitive) {
  const Json& materials = gltfList(document, "materials");
  const auto material = gltfWhole(primitive, "material");
  if (!material || *material >= materials.size()) return {};
  const Json* texture = objectAt(materials[*material],
                                 "/extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture");
  if (texture == nullptr) {
    texture = objectAt(materials[*material], "/pbrMetallicRoughness/baseColorTexture");
  }
  if (texture == nullptr) return {};
  Mapping mapping{.set = gltfWhole(*texture, "texCoord").value_or(0)};
  const Json* extension = objectAt(*texture, "/extensions/KHR_texture_transform");
  if (extension == nullptr) return mapping;
  mapping.set = gltfWhole(*extension, "texCoord").value_or(mapping.set);
  mapping.image_from_uv = transformOf(*extension);
  return mapping;
}

/// Replaces accessors of primitives with ones that the reader interprets correctly.
class PrimitiveWriter {
 public:
  PrimitiveWriter(Json& document, GltfAccessors& accessors)
      : document_(document), accessors_(accessors) {}

  /// Returns whether any accessor was replaced.
  Result<bool> run() {
    bool changes = false;
    if (!document_.contains("meshes") || !document_["meshes"].is_array()) return false;
    for (Json& mesh : document_["meshes"]) {
      if (!mesh.is_object() || !mesh.contains("primitives")) continue;
      for (Json& primitive : mesh["primitives"]) {
        ASSIGN_OR_RETURN(const bool changed, rewrite(primitive));
        changes = changes || changed;
      }
    }
    return changes;
  }

 private:
  Result<bool> rewrite(Json& primitive) {
    if (!primitive.is_object() || !primitive.contains("attributes")) return false;
    Json& attributes = primitive["attributes"];
    if (!attributes.is_object()) return false;
    ASSIGN_OR_RETURN(bool changes, placeTexture(primitive, attributes));
    std::vector<Json*> shapes{&attributes};
    if (primitive.contains("targets") && primitive["targets"].is_array()) {
      for (Json& target : primitive["targets"]) shapes.push_back(&target);
    }
    for (Json* shape : shapes) {
      ASSIGN_OR_RETURN(const bool changed, makeFloats(*shape));
      changes = changes || changed;
    }
    return changes;
  }

  /// Makes TEXCOORD_0 the coordinates that the color texture is drawn with.
  Result<bool> placeTexture(const Json& primitive, Json& attributes) {
    const Mapping mapping = mappingOf(document_, primitive);
    const std::string named = "TEXCOORD_" + std::to_string(mapping.set);
    const auto source = gltfWhole(attributes, named.c_str());
    if (!source) return false;
    ASSIGN_OR_RETURN(const auto drawn, drawnFrom(*source, mapping.image_from_uv));
    if (!drawn || attributes.value("TEXCOORD_0", Json()) == Json(*drawn)) return false;
    attributes["TEXCOORD_0"] = *drawn;
    return true;
  }

  /// An accessor of the transformed coordinates; none if `source` cannot be read.
  Result<std::optional<std::uint64_t>> drawnFrom(std::uint64_t source, const UvTransform& m) {
    if (accessors_.isFloat(source) && m == kUnmoved) return source;
    const auto made = made_.find({source, m});
    if (made != made_.end()) return made->second;
    ASSIGN_OR_RETURN(auto uvs, accessors_.read(source, kTexelCoordinates));
    if (!uvs) return std::nullopt;
    for (std::size_t n = 0; n < uvs->size(); n += kTexelCoordinates) {
      const double u = (*uvs)[n];
      const double v = (*uvs)[n + 1];
      (*uvs)[n] = m[0] * u + m[1] * v + m[2];
      (*uvs)[n + 1] = m[3] * u + m[4] * v + m[5];
    }
    const std::uint64_t drawn = accessors_.append(*uvs, kTexelCoordinates);
    made_.emplace(std::pair(source, m), drawn);
    return drawn;
  }

  /// Undoes KHR_mesh_quantization: turns integer positions into floats, and drops integer
  /// directions, which nothing uses.
  Result<bool> makeFloats(Json& attributes) {
    bool changes = false;
    for (const char* name : {"POSITION", "NORMAL", "TANGENT"}) {
      const auto source = gltfWhole(attributes, name);
      if (!source || accessors_.isFloat(*source)) continue;
      if (std::string_view(name) != "POSITION") {
        attributes.erase(name);
        changes = true;
        continue;
      }
      ASSIGN_OR_RETURN(const auto floats, floatsOf(*source));
      if (!floats) continue;
      attributes[name] = *floats;
      changes = true;
    }
    return changes;
  }

  Result<std::optional<std::uint64_t>> floatsOf(std::uint64_t source) {
    const auto [made, is_new] = floats_.try_emplace(source);
    if (!is_new) return made->second;
    ASSIGN_OR_RETURN(const auto numbers, accessors_.read(source, kSpaceCoordinates));
    if (numbers) {
      made->second = accessors_.append(*numbers, kSpaceCoordinates);
    }
    return made->second;
  }

  Json& document_;
  GltfAccessors& accessors_;
  /// Accessors of transformed coordinates, by their source and transform.
  std::map<std::pair<std::uint64_t, UvTransform>, std::uint64_t> made_;
  /// Accessors of positions as floats, by their source.
  std::map<std::uint64_t, std::optional<std::uint64_t>> floats_;
};

/// Removes skins, so that meshes stand where their nodes are, whatever the bones say. Returns
/// whether there were any.
bool dropSkins(Json& document) {
  if (document.erase("skins") == 0) return false;
  if (!document.contains("nodes")) return true;
  for (Json& node : document["nodes"]) {
    if (node.is_object()) node.erase("skin");
  }
  return true;
}

/// The file with its JSON replaced by `json`.
std::string withJson(Bytes file, std::string json) {
  if (!isGlb(file)) return json;
  constexpr std::size_t kAlignment = 4;
  json.resize((json.size() + kAlignment - 1) / kAlignment * kAlignment, ' ');
  const Bytes rest = gltfBehindJson(file);
  std::string glb(reinterpret_cast<const char*>(file.data()), kGlbHeader + kGlbChunkHeader);
  const auto put = [&glb](std::size_t at, std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    std::memcpy(glb.data() + at, &word, sizeof(word));
  };
  put(kGlbHeader - sizeof(std::uint32_t), glb.size() + json.size() + rest.size());
  put(kGlbHeader, json.size());
  glb.reserve(glb.size() + json.size() + rest.size());
  glb += json;
  glb.append(reinterpret_cast<const char*>(rest.data()), rest.size());
  return glb;
}

/// Whether the JSON has anything that a reader may misinterpret; searching the text is cheap.
bool mayDiffer(Bytes file) {
  const Bytes json = gltfJson(file);
  const std::string_view text(reinterpret_cast<const char*>(json.data()), json.size());
  constexpr std::array<std::string_view, 5> kCauses{"\"normalized\"", "\"texCoord\"",
                                                    "\"KHR_texture_transform\"",
                                                    "\"KHR_mesh_quantization\"", "\"skins\""};
  return std::ranges::any_of(kCauses,
                             [&](std::string_view cause) { return text.find(cause) != text.npos; });
}

}  // namespace

Result<std::optional<ReadableGltf>> readableGltf(const fs::path& path, Bytes file, Reach reach) {
  if (!mayDiffer(file)) return std::nullopt;
  Json document = parseGltf(file);
  if (!document.is_object()) return std::nullopt;
  GltfAccessors accessors(document, path, file, reach);
  const bool had_skins = dropSkins(document);
  ASSIGN_OR_RETURN(const bool has_others, PrimitiveWriter(document, accessors).run());
  if (!had_skins && !has_others) return std::nullopt;
  std::string floats = accessors.finish(kGltfFloatsFile);
  return ReadableGltf{.file = withJson(file, document.dump()), .floats = std::move(floats)};
}

}  // namespace galactic::bake
