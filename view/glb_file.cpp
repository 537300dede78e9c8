#include "view/glb_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace galactic {

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

/// Vertex colors of glTF are linear: 16 bits keep the dark ones apart.
std::uint16_t linearFromSrgb(std::uint32_t value) {
  constexpr double kEight = 255;
  constexpr double kSixteen = 65535;
  const double srgb = value / kEight;
  const double linear = srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
  return static_cast<std::uint16_t>(std::lround(linear * kSixteen));
}

/// As renderers of packs read textures.
void writeSampler(JsonWriter& json) {
  constexpr int kLinear = 9729;
  constexpr int kLinearOfNearestLevel = 9985;
  constexpr int kRepeat = 10497;
  json.begin("", '{');
  json.number("magFilter", kLinear);
  json.number("minFilter", kLinearOfNearestLevel);
  json.number("wrapS", kRepeat);
  json.number("wrapT", kRepeat);
  json.end('}');
}

std::span<const float> listOf(const Vec3& v) { return {&v.x, 3}; }

/// Validators want rotations of length one, and no component beyond 1: composed ones are off by a
/// few roundings.
Quat unitOf(const Quat& q) {
  const auto wide = [](float value) { return static_cast<double>(value); };
  const double length =
      std::hypot(std::hypot(wide(q.x), wide(q.y)), std::hypot(wide(q.z), wide(q.w)));
  const auto part = [&](float value) {
    return std::clamp(static_cast<float>(wide(value) / length), -1.0F, 1.0F);
  };
  return length > 0 ? Quat{part(q.x), part(q.y), part(q.z), part(q.w)} : Quat{};
}

JsonWriter object() {
  JsonWriter json(JsonLayout::kCompact);
  json.begin('{');
  return json;
}

std::string closed(JsonWriter& json) {
  json.end('}');
  return json.take();
}

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
  JsonWriter image = object();
  image.text("name", name);
  image.text("mimeType", "image/png");
  image.number("bufferView", addView(std::as_bytes(std::span(png)), std::nullopt));
  images_.push_back(closed(image));
  JsonWriter texture = object();
  texture.number("sampler", 0);
  texture.number("source", images_.size() - 1);
  textures_.push_back(closed(texture));
  return textures_.size() - 1;
}

std::size_t GlbFile::addMaterial(const GlbMaterial& material) {
  JsonWriter json = object();
  json.text("name", material.name);
  json.begin("pbrMetallicRoughness", '{');
  json.numbers("baseColorFactor", std::span<const float>(material.color));
  json.number("metallicFactor", 0);
  json.number("roughnessFactor", 1);
  if (material.texture) {
    json.begin("baseColorTexture", '{');
    json.number("index", *material.texture);
    json.end('}');
  }
  json.end('}');
  if (material.two_sided) json.truth("doubleSided", true);
  if (material.alpha_cutoff > 0) {
    json.text("alphaMode", "MASK");
    json.number("alphaCutoff", material.alpha_cutoff);
  } else if (material.color[3] < 1) {
    json.text("alphaMode", "BLEND");
  }
  if (material.unlit) {
    has_unlit_ = true;
    json.raw("extensions", R"({"KHR_materials_unlit":{}})");
  }
  materials_.push_back(closed(json));
  return materials_.size() - 1;
}

void GlbFile::writePrimitive(JsonWriter& json, const GlbPrimitive& primitive) {
  json.begin("", '{');
  json.begin("attributes", '{');
  json.number("POSITION", addVectors(primitive.positions));
  if (!primitive.normals.empty()) json.number("NORMAL", addVectors(primitive.normals));
  if (!primitive.uvs.empty()) json.number("TEXCOORD_0", addUvs(primitive.uvs));
  if (!primitive.colors.empty()) json.number("COLOR_0", addColors(primitive.colors));
  json.end('}');
  json.number("indices", addIndices(primitive.corners));
  json.number("material", primitive.material);
  json.number("mode", static_cast<int>(primitive.shape));
  json.end('}');
}

std::size_t GlbFile::addMesh(std::string_view name, std::span<const GlbPrimitive> primitives) {
  JsonWriter json = object();
  json.text("name", name);
  json.begin("primitives", '[');
  for (const GlbPrimitive& primitive : primitives) writePrimitive(json, primitive);
  json.end(']');
  meshes_.push_back(closed(json));
  return meshes_.size() - 1;
}

std::size_t GlbFile::addNode(const GlbNode& node) {
  const std::size_t index = nodes_.size();
  Node& added = nodes_.emplace_back(Node{node, std::nullopt, {}});
  if (node.camera_fov) {
    constexpr double kNear = 0.01;
    JsonWriter camera = object();
    camera.text("type", "perspective");
    camera.begin("perspective", '{');
    camera.number("yfov", *node.camera_fov);
    camera.number("znear", kNear);
    camera.end('}');
    added.camera = cameras_.size();
    cameras_.push_back(closed(camera));
  }
  if (node.parent) {
    nodes_[*node.parent].children.push_back(index);
  } else {
    roots_.push_back(index);
  }
  return index;
}

void GlbFile::writeNode(JsonWriter& json, const Node& node) {
  const Pose& pose = node.node.parent_from_node;
  json.begin("", '{');
  json.text("name", node.node.name);
  if (pose.translation != Vec3{}) json.numbers("translation", listOf(pose.translation));
  if (const Quat rotation = unitOf(pose.rotation); rotation != Quat{}) {
    json.numbers("rotation", std::span<const float>(&rotation.x, 4));
  }
  if (node.node.scale != Vec3{1, 1, 1}) json.numbers("scale", listOf(node.node.scale));
  if (node.node.mesh) json.number("mesh", *node.node.mesh);
  if (node.camera) json.number("camera", *node.camera);
  if (!node.children.empty()) {
    json.numbers("children", std::span<const std::size_t>(node.children));
  }
  json.end('}');
}

void GlbFile::addAnimation(std::string_view name, std::span<const float> times,
                           std::span<const GlbMotion> motions) {
  JsonWriter input = object();
  input.number("bufferView", addView(std::as_bytes(times), std::nullopt));
  input.number("componentType", kFloat);
  input.number("count", times.size());
  input.text("type", "SCALAR");
  input.numbers("min", times.first(1));
  input.numbers("max", times.last(1));
  const std::size_t input_number = addAccessor(std::move(input));

  std::vector<std::size_t> outputs;
  for (const GlbMotion& motion : motions) {
    std::vector<Vec3> places;
    std::vector<Quat> turns;
    for (const Pose& pose : motion.parent_from_node) {
      // The shorter way from one key to the next is the one without a change of sign.
      const Quat q = unitOf(pose.rotation);
      const Quat& last = turns.empty() ? q : turns.back();
      const bool is_far = q.x * last.x + q.y * last.y + q.z * last.z + q.w * last.w < 0;
      places.push_back(pose.translation);
      turns.push_back(is_far ? Quat{-q.x, -q.y, -q.z, -q.w} : q);
    }
    outputs.push_back(addKeys(std::as_bytes(std::span(places)), places.size(), "VEC3"));
    outputs.push_back(addKeys(std::as_bytes(std::span(turns)), turns.size(), "VEC4"));
  }
  JsonWriter json = object();
  json.text("name", name);
  json.begin("samplers", '[');
  for (const std::size_t output : outputs) {
    json.begin("", '{');
    json.number("input", input_number);
    json.number("output", output);
    json.end('}');
  }
  json.end(']');
  json.begin("channels", '[');
  for (std::size_t n = 0; n < outputs.size(); ++n) {
    json.begin("", '{');
    json.number("sampler", n);
    json.begin("target", '{');
    json.number("node", motions[n / 2].node);
    json.text("path", n % 2 == 0 ? "translation" : "rotation");
    json.end('}');
    json.end('}');
  }
  json.end(']');
  animations_.push_back(closed(json));
}

Result<std::string> GlbFile::bytes() const {
  JsonWriter json = object();
  json.raw("asset", R"({"version":"2.0","generator":"galactic"})");
  json.number("scene", 0);
  json.begin("scenes", '[');
  json.begin("", '{');
  // Empty lists are not allowed.
  if (!roots_.empty()) json.numbers("nodes", std::span<const std::size_t>(roots_));
  json.end('}');
  json.end(']');
  const auto add = [&json](std::string_view key, const std::vector<std::string>& list) {
    if (list.empty()) return;
    json.begin(key, '[');
    for (const std::string& one : list) json.raw("", one);
    json.end(']');
  };
  if (!nodes_.empty()) {
    json.begin("nodes", '[');
    for (const Node& node : nodes_) writeNode(json, node);
    json.end(']');
  }
  add("meshes", meshes_);
  add("cameras", cameras_);
  add("materials", materials_);
  add("textures", textures_);
  add("images", images_);
  add("animations", animations_);
  if (!textures_.empty()) {
    json.begin("samplers", '[');
    writeSampler(json);
    json.end(']');
  }
  if (has_unlit_) json.raw("extensionsUsed", R"(["KHR_materials_unlit"])");
  add("accessors", accessors_);
  add("bufferViews", views_);
  std::string binary = binary_;
  pad(binary, '\0');
  if (!binary.empty()) json.raw("buffers", fmt::format("[{{\"byteLength\":{}}}]", binary.size()));
  std::string text = closed(json);
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
  JsonWriter view = object();
  view.number("buffer", 0);
  view.number("byteOffset", binary_.size());
  view.number("byteLength", data.size());
  if (target) view.number("target", *target);
  views_.push_back(closed(view));
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
  JsonWriter accessor = object();
  accessor.number("bufferView", addView(std::as_bytes(vectors), kArrayBuffer));
  accessor.number("componentType", kFloat);
  accessor.number("count", vectors.size());
  accessor.text("type", "VEC3");
  accessor.numbers("min", listOf(low));
  accessor.numbers("max", listOf(high));
  return addAccessor(std::move(accessor));
}

std::size_t GlbFile::addUvs(std::span<const std::array<float, 2>> uvs) {
  JsonWriter accessor = object();
  accessor.number("bufferView", addView(std::as_bytes(uvs), kArrayBuffer));
  accessor.number("componentType", kFloat);
  accessor.number("count", uvs.size());
  accessor.text("type", "VEC2");
  return addAccessor(std::move(accessor));
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
  JsonWriter accessor = object();
  accessor.number("bufferView", addView(std::as_bytes(std::span(channels)), kArrayBuffer));
  accessor.number("componentType", kUnsignedShort);
  accessor.truth("normalized", true);
  accessor.number("count", colors.size());
  accessor.text("type", "VEC4");
  return addAccessor(std::move(accessor));
}

std::size_t GlbFile::addIndices(std::span<const std::uint32_t> indices) {
  JsonWriter accessor = object();
  accessor.number("bufferView", addView(std::as_bytes(indices), kElementArrayBuffer));
  accessor.number("componentType", kUnsignedInt);
  accessor.number("count", indices.size());
  accessor.text("type", "SCALAR");
  return addAccessor(std::move(accessor));
}

std::size_t GlbFile::addKeys(std::span<const std::byte> keys, std::size_t count,
                             std::string_view type) {
  JsonWriter accessor = object();
  accessor.number("bufferView", addView(keys, std::nullopt));
  accessor.number("componentType", kFloat);
  accessor.number("count", count);
  accessor.text("type", type);
  return addAccessor(std::move(accessor));
}

std::size_t GlbFile::addAccessor(JsonWriter accessor) {
  accessors_.push_back(closed(accessor));
  return accessors_.size() - 1;
}

}  // namespace galactic
