#include "pack_tool/mesh/glb_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace galactic::pack_tool {

namespace {

static_assert(std::endian::native == std::endian::little, "GLB files are written as they lie");

// Numbers of the specification.
constexpr std::uint32_t kMagic = 0x46546c67;  // "glTF"
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004e4942;  // "BIN"
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kFloat = 5126;
constexpr std::size_t kAlignment = 4;
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;

void pad(std::string& bytes, char with) {
  bytes.resize((bytes.size() + kAlignment - 1) / kAlignment * kAlignment, with);
}

void appendNumber(std::string& bytes, std::size_t number) {
  const auto value = static_cast<std::uint32_t>(number);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void appendChunk(std::string& file, std::uint32_t type, const std::string& content) {
  appendNumber(file, content.size());
  appendNumber(file, type);
  file += content;
}

/// Vertex colours of glTF are linear: 16 bits keep the dark ones apart.
std::uint16_t linearFromSrgb(std::uint32_t value) {
  constexpr double kEight = 255;
  constexpr double kSixteen = 65535;
  const double srgb = value / kEight;
  const double linear = srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
  return static_cast<std::uint16_t>(std::lround(linear * kSixteen));
}

/// As renderers of packs read textures.
nlohmann::ordered_json samplerJson() {
  constexpr int kLinear = 9729;
  constexpr int kLinearOfNearestLevel = 9985;
  constexpr int kRepeat = 10497;
  return {{"magFilter", kLinear},
          {"minFilter", kLinearOfNearestLevel},
          {"wrapS", kRepeat},
          {"wrapT", kRepeat}};
}

nlohmann::ordered_json listOf(const Vec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

std::array<float, 4> linearColor(std::uint32_t color) {
  constexpr float kSixteen = 65535;
  constexpr float kEight = 255;
  std::array<float, 4> linear{};
  for (unsigned channel = 0; channel < 3; ++channel) {
    linear[channel] = static_cast<float>(linearFromSrgb(color >> (8 * channel) & 0xffU)) / kSixteen;
  }
  linear[3] = static_cast<float>(color >> 24U) / kEight;
  return linear;
}

std::size_t GlbFile::addTexture(std::string_view name, const std::string& png) {
  images_.push_back({{"name", name},
                     {"mimeType", "image/png"},
                     {"bufferView", addView(std::as_bytes(std::span(png)), std::nullopt)}});
  textures_.push_back({{"sampler", 0}, {"source", images_.size() - 1}});
  return textures_.size() - 1;
}

std::size_t GlbFile::addMaterial(const GlbMaterial& material) {
  Json surface{{"baseColorFactor", material.color}, {"metallicFactor", 0}, {"roughnessFactor", 1}};
  if (material.texture) surface["baseColorTexture"] = {{"index", *material.texture}};
  Json json{{"name", material.name}, {"pbrMetallicRoughness", std::move(surface)}};
  if (material.two_sided) json["doubleSided"] = true;
  if (material.alpha_cutoff > 0) {
    json["alphaMode"] = "MASK";
    json["alphaCutoff"] = material.alpha_cutoff;
  } else if (material.color[3] < 1) {
    json["alphaMode"] = "BLEND";
  }
  if (material.unlit) {
    has_unlit_ = true;
    json["extensions"] = {{"KHR_materials_unlit", Json::object()}};
  }
  materials_.push_back(std::move(json));
  return materials_.size() - 1;
}

GlbFile::Json GlbFile::primitiveOf(const GlbPrimitive& primitive) {
  Json attributes{{"POSITION", addVectors(primitive.positions)}};
  if (!primitive.normals.empty()) attributes["NORMAL"] = addVectors(primitive.normals);
  if (!primitive.uvs.empty()) attributes["TEXCOORD_0"] = addUvs(primitive.uvs);
  if (!primitive.colors.empty()) attributes["COLOR_0"] = addColors(primitive.colors);
  return {{"attributes", std::move(attributes)},
          {"indices", addIndices(primitive.corners)},
          {"material", primitive.material},
          {"mode", static_cast<int>(primitive.shape)}};
}

std::size_t GlbFile::addMesh(std::string_view name, std::span<const GlbPrimitive> primitives) {
  Json list = Json::array();
  for (const GlbPrimitive& primitive : primitives) list.push_back(primitiveOf(primitive));
  meshes_.push_back({{"name", name}, {"primitives", std::move(list)}});
  return meshes_.size() - 1;
}

std::size_t GlbFile::addNode(const GlbNode& node) {
  const std::size_t index = nodes_.size();
  Json json{{"name", node.name}};
  const Pose& pose = node.parent_from_node;
  if (pose.translation != Vec3{}) json["translation"] = listOf(pose.translation);
  if (pose.rotation != Quat{}) {
    const Quat& q = pose.rotation;
    json["rotation"] = {q.x, q.y, q.z, q.w};
  }
  if (node.scale != Vec3{1, 1, 1}) json["scale"] = listOf(node.scale);
  if (node.mesh) json["mesh"] = *node.mesh;
  if (node.camera_fov) {
    constexpr double kNear = 0.01;
    json["camera"] = cameras_.size();
    cameras_.push_back(
        {{"type", "perspective"}, {"perspective", {{"yfov", *node.camera_fov}, {"znear", kNear}}}});
  }
  nodes_.push_back(std::move(json));
  if (node.parent) {
    nodes_[*node.parent]["children"].push_back(index);
  } else {
    roots_.push_back(index);
  }
  return index;
}

Result<std::string> GlbFile::bytes() const {
  Json json{{"asset", {{"version", "2.0"}, {"generator", "galactic-pack"}}}, {"scene", 0}};
  json["scenes"] = Json::array({Json::object()});
  // Empty lists are not allowed.
  const auto add = [](Json& to, const char* key, const Json& list) {
    if (!list.empty()) to[key] = list;
  };
  add(json["scenes"][0], "nodes", Json(roots_));
  add(json, "nodes", nodes_);
  add(json, "meshes", meshes_);
  add(json, "cameras", cameras_);
  add(json, "materials", materials_);
  add(json, "textures", textures_);
  add(json, "images", images_);
  if (!textures_.empty()) json["samplers"] = Json::array({samplerJson()});
  if (has_unlit_) json["extensionsUsed"] = Json::array({"KHR_materials_unlit"});
  add(json, "accessors", accessors_);
  add(json, "bufferViews", views_);
  std::string binary = binary_;
  pad(binary, '\0');
  if (!binary.empty()) json["buffers"] = Json::array({{{"byteLength", binary.size()}}});
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  pad(text, ' ');

  const std::size_t size = kHeaderBytes + kChunkHeaderBytes + text.size() +
                           (binary.empty() ? 0 : kChunkHeaderBytes + binary.size());
  if (size > std::numeric_limits<std::uint32_t>::max()) {
    return fail(ErrorCode::kUnsupported, "",
                "would be larger than 4 GiB, the limit of a GLB file; export one --object or less "
                "with --what");
  }
  std::string file;
  file.reserve(size);
  appendNumber(file, kMagic);
  appendNumber(file, kVersion);
  appendNumber(file, size);
  appendChunk(file, kJsonChunk, text);
  if (!binary.empty()) appendChunk(file, kBinaryChunk, binary);
  return file;
}

std::size_t GlbFile::addView(std::span<const std::byte> data, std::optional<int> target) {
  pad(binary_, '\0');
  Json view{{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", data.size()}};
  if (target) view["target"] = *target;
  views_.push_back(std::move(view));
  binary_.append(reinterpret_cast<const char*>(data.data()), data.size());
  return views_.size() - 1;
}

std::size_t GlbFile::addVectors(std::span<const Vec3> vectors) {
  Vec3 low = vectors.front();
  Vec3 high = low;
  for (const Vec3& v : vectors) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
  return addAccessor({{"bufferView", addView(std::as_bytes(vectors), kArrayBuffer)},
                      {"componentType", kFloat},
                      {"count", vectors.size()},
                      {"type", "VEC3"},
                      {"min", listOf(low)},
                      {"max", listOf(high)}});
}

std::size_t GlbFile::addUvs(std::span<const std::array<float, 2>> uvs) {
  return addAccessor({{"bufferView", addView(std::as_bytes(uvs), kArrayBuffer)},
                      {"componentType", kFloat},
                      {"count", uvs.size()},
                      {"type", "VEC2"}});
}

std::size_t GlbFile::addColors(std::span<const std::uint32_t> colors) {
  std::array<std::uint16_t, 256> linear{};
  for (std::uint32_t value = 0; value < linear.size(); ++value) {
    linear[value] = linearFromSrgb(value);
  }
  std::vector<std::uint16_t> channels;
  channels.reserve(4 * colors.size());
  for (const std::uint32_t color : colors) {
    for (unsigned shift = 0; shift < 24; shift += 8) {
      channels.push_back(linear[(color >> shift) & 0xffU]);
    }
    // Alpha is linear as it is.
    channels.push_back(static_cast<std::uint16_t>((color >> 24U) * 257U));
  }
  return addAccessor({{"bufferView", addView(std::as_bytes(std::span(channels)), kArrayBuffer)},
                      {"componentType", kUnsignedShort},
                      {"normalized", true},
                      {"count", colors.size()},
                      {"type", "VEC4"}});
}

std::size_t GlbFile::addIndices(std::span<const std::uint32_t> indices) {
  return addAccessor({{"bufferView", addView(std::as_bytes(indices), kElementArrayBuffer)},
                      {"componentType", kUnsignedInt},
                      {"count", indices.size()},
                      {"type", "SCALAR"}});
}

std::size_t GlbFile::addAccessor(Json accessor) {
  accessors_.push_back(std::move(accessor));
  return accessors_.size() - 1;
}

}  // namespace galactic::pack_tool
