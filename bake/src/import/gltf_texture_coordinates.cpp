#include "import/gltf_texture_coordinates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "import/gltf_json.h"
#include "support/mapped_file.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Bytes = std::span<const std::byte>;

constexpr std::uint64_t kFloat = 5126;
constexpr std::size_t kTexelCoordinates = 2;

/// Rows of the transform from the coordinates of a set to those of the image.
using UvTransform = std::array<double, 6>;
constexpr UvTransform kUnmoved{1, 0, 0, 0, 1, 0};

/// Where a texture is drawn.
struct Mapping {
  std::uint64_t set = 0;
  UvTransform image_from_uv = kUnmoved;
};

/// The object at `pointer` below `parent`; null where there is none.
const Json* objectAt(const Json& parent, const char* pointer) {
  const Json::json_pointer at(pointer);
  if (!parent.contains(at)) return nullptr;
  const Json& found = parent.at(at);
  return found.is_object() ? &found : nullptr;
}

/// The two numbers of a list; `otherwise` where they are none.
std::array<double, 2> pairOf(const Json& object, const char* key,
                             const std::array<double, 2>& otherwise) {
  const auto list = object.find(key);
  const bool is_pair = list != object.end() && list->is_array() && list->size() == 2 &&
                       (*list)[0].is_number() && (*list)[1].is_number();
  if (!is_pair) return otherwise;
  return {(*list)[0].get<double>(), (*list)[1].get<double>()};
}

/// KHR_texture_transform: scaled, then turned, then moved. Positive angles turn u towards -v, which
/// is up: https://github.com/KhronosGroup/glTF/issues/1563.
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

/// How the texture lies that a primitive's color comes from.
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

constexpr std::uint8_t kNoDigit = 0xFF;
constexpr std::array<std::uint8_t, 256> kBase64 = [] {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<std::uint8_t, 256> values{};
  values.fill(kNoDigit);
  for (std::size_t n = 0; n < kDigits.size(); ++n) {
    values[static_cast<unsigned char>(kDigits[n])] = static_cast<std::uint8_t>(n);
  }
  return values;
}();

std::string base64Decoded(std::string_view text) {
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  unsigned count = 0;
  for (const char c : text) {
    const std::uint8_t digit = kBase64[static_cast<unsigned char>(c)];
    if (digit == kNoDigit) break;
    bits = bits << 6U | digit;
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xFFU);
  }
  return bytes;
}

/// The bytes of a document's buffers, each looked for once; empty where they are not to be had.
class Buffers {
 public:
  Buffers(const fs::path& path, Bytes file, Reach reach)
      : folder_(path.parent_path()), file_(file), reach_(reach) {}

  Bytes of(const Json& document, std::uint64_t number) {
    const Json& buffers = gltfList(document, "buffers");
    if (number >= buffers.size()) return {};
    const auto uri = buffers[number].find("uri");
    if (uri == buffers[number].end()) return number == 0 ? ownBuffer() : Bytes();
    if (!uri->is_string()) return {};
    const auto [entry, is_new] = found_.try_emplace(number);
    if (is_new) entry->second = find(uri->get_ref<const std::string&>());
    if (entry->second.mapped) return entry->second.mapped->bytes();
    return std::as_bytes(std::span(entry->second.decoded));
  }

 private:
  struct Buffer {
    std::optional<MappedFile> mapped;
    std::string decoded;
  };

  [[nodiscard]] Bytes ownBuffer() const {
    const Bytes chunk = gltfBehindJson(file_);
    if (chunk.size() < kGlbChunkHeader) return {};
    const std::size_t length = gltfWordAt(chunk, 0);
    return chunk.subspan(kGlbChunkHeader, std::min(length, chunk.size() - kGlbChunkHeader));
  }

  [[nodiscard]] Buffer find(const std::string& uri) const {
    if (uri.starts_with("data:")) {
      const std::size_t comma = uri.find(',');
      if (comma == uri.npos || !uri.substr(0, comma).ends_with(";base64")) return {};
      return {.mapped = std::nullopt,
              .decoded = base64Decoded(std::string_view(uri).substr(comma + 1))};
    }
    for (const std::string& name : {uri, withoutUriEscapes(uri)}) {
      if (reach_ == Reach::kNear && !isBelow(folder_ / name, folder_)) continue;
      if (auto mapped = MappedFile::open(folder_ / name)) {
        return {.mapped = std::move(*mapped), .decoded = {}};
      }
    }
    return {};
  }

  fs::path folder_;
  Bytes file_;
  Reach reach_;
  std::map<std::uint64_t, Buffer> found_;
};

/// Elements of an accessor in their buffer.
struct Elements {
  Bytes bytes;
  std::size_t stride = 0;
};

template <class T>
double numberAt(const std::byte* at) {
  T value{};
  std::memcpy(&value, at, sizeof(T));
  return static_cast<double>(value);
}

/// One component; `normalized` integers stand for 0 to 1, or -1 to 1.
double componentAt(const std::byte* at, std::uint64_t type, bool normalized) {
  const auto share = [normalized](double value, double one) {
    return normalized ? std::max(value / one, -1.0) : value;
  };
  switch (type) {
    case 5120:
      return share(numberAt<std::int8_t>(at), 127);
    case 5121:
      return share(numberAt<std::uint8_t>(at), 255);
    case 5122:
      return share(numberAt<std::int16_t>(at), 32767);
    case 5123:
      return share(numberAt<std::uint16_t>(at), 65535);
    case 5125:
      return share(numberAt<std::uint32_t>(at), 4294967295);
    default:
      return numberAt<float>(at);
  }
}

class CoordinateWriter {
 public:
  CoordinateWriter(Json& document, Buffers& buffers) : document_(document), buffers_(buffers) {}

  /// Gives each primitive its drawn coordinates; whether any got others than it had.
  bool run() {
    bool changes = false;
    if (!document_.contains("meshes") || !document_["meshes"].is_array()) return false;
    for (Json& mesh : document_["meshes"]) {
      if (!mesh.is_object() || !mesh.contains("primitives")) continue;
      for (Json& primitive : mesh["primitives"]) changes = rewrite(primitive) || changes;
    }
    if (!floats_.empty()) {
      document_["buffers"].push_back(
          {{"uri", kTextureCoordinatesFile}, {"byteLength", floats_.size()}});
    }
    return changes;
  }

  std::string takeFloats() { return std::move(floats_); }

 private:
  bool rewrite(Json& primitive) {
    if (!primitive.is_object() || !primitive.contains("attributes")) return false;
    Json& attributes = primitive["attributes"];
    if (!attributes.is_object()) return false;
    const Mapping mapping = mappingOf(document_, primitive);
    const std::string named = "TEXCOORD_" + std::to_string(mapping.set);
    const auto source = gltfWhole(attributes, named.c_str());
    if (!source) return false;
    const auto drawn = drawnFrom(*source, mapping.image_from_uv);
    if (!drawn || attributes.value("TEXCOORD_0", Json()) == Json(*drawn)) return false;
    attributes["TEXCOORD_0"] = *drawn;
    return true;
  }

  /// The accessor of the moved coordinates; none where the one that is named cannot be read.
  std::optional<std::uint64_t> drawnFrom(std::uint64_t source, const UvTransform& image_from_uv) {
    const Json& accessors = gltfList(document_, "accessors");
    if (source >= accessors.size() || !accessors[source].is_object()) return std::nullopt;
    const bool is_float = gltfWhole(accessors[source], "componentType") == kFloat;
    if (is_float && image_from_uv == kUnmoved) return source;
    const auto made = made_.find({source, image_from_uv});
    if (made != made_.end()) return made->second;
    auto uvs = read(accessors[source]);
    if (!uvs) return std::nullopt;
    const std::uint64_t drawn = append(*uvs, image_from_uv);
    made_.emplace(std::pair(source, image_from_uv), drawn);
    return drawn;
  }

  std::uint64_t append(const std::vector<std::array<double, 2>>& uvs, const UvTransform& m) {
    const std::size_t first = floats_.size();
    for (const auto& [u, v] : uvs) {
      put(m[0] * u + m[1] * v + m[2]);
      put(m[3] * u + m[4] * v + m[5]);
    }
    Json& views = document_["bufferViews"];
    views.push_back({{"buffer", document_["buffers"].size()},
                     {"byteOffset", first},
                     {"byteLength", floats_.size() - first}});
    Json& accessors = document_["accessors"];
    accessors.push_back({{"bufferView", views.size() - 1},
                         {"componentType", kFloat},
                         {"count", uvs.size()},
                         {"type", "VEC2"}});
    return accessors.size() - 1;
  }

  void put(double value) {
    constexpr double kLargest = static_cast<double>(std::numeric_limits<float>::max());
    const auto number = static_cast<float>(std::clamp(value, -kLargest, kLargest));
    floats_.append(reinterpret_cast<const char*>(&number), sizeof(number));
  }

  std::optional<std::vector<std::array<double, 2>>> read(const Json& accessor) {
    const std::uint64_t type = gltfWhole(accessor, "componentType").value_or(0);
    const auto count = gltfWhole(accessor, "count");
    const std::uint64_t bytes = gltfComponentBytes(type);
    if (!count || *count == 0 || bytes == 0 || gltfText(accessor, "type") != "VEC2")
      return std::nullopt;
    const auto elements = elementsOf(accessor, *count, kTexelCoordinates * bytes);
    if (!elements) return std::nullopt;
    const auto normalized = accessor.find("normalized");
    const bool is_normalized = normalized != accessor.end() && *normalized == true;
    const auto uv_at = [&](const Elements& from, std::uint64_t n) -> std::array<double, 2> {
      const std::byte* at = from.bytes.data() + n * from.stride;
      return {componentAt(at, type, is_normalized), componentAt(at + bytes, type, is_normalized)};
    };
    std::vector<std::array<double, 2>> uvs(*count);
    for (std::uint64_t n = 0; n < *count; ++n) uvs[n] = uv_at(*elements, n);
    const Json* sparse = objectAt(accessor, "/sparse");
    if (sparse == nullptr) return uvs;
    const Json* indices = objectAt(*sparse, "/indices");
    const Json* values = objectAt(*sparse, "/values");
    if (indices == nullptr || values == nullptr) return std::nullopt;
    const std::uint64_t index_type = gltfWhole(*indices, "componentType").value_or(0);
    const std::uint64_t some = gltfWhole(*sparse, "count").value_or(0);
    const auto places = elementsOf(*indices, some, gltfComponentBytes(index_type));
    const auto replaced = elementsOf(*values, some, kTexelCoordinates * bytes);
    if (!places || !replaced) return std::nullopt;
    for (std::uint64_t n = 0; n < some; ++n) {
      const double place =
          componentAt(places->bytes.data() + n * places->stride, index_type, false);
      if (!(place >= 0 && place < static_cast<double>(*count))) return std::nullopt;
      uvs[static_cast<std::size_t>(place)] = uv_at(*replaced, n);
    }
    return uvs;
  }

  /// `count` elements of `bytes` each in the buffer view that `owner` names; none where it does not
  /// have so many.
  std::optional<Elements> elementsOf(const Json& owner, std::uint64_t count, std::uint64_t bytes) {
    const Json& views = gltfList(document_, "bufferViews");
    const auto number = gltfWhole(owner, "bufferView");
    if (!number || *number >= views.size() || bytes == 0) return std::nullopt;
    const Json& view = views[*number];
    const auto buffer = gltfWhole(view, "buffer");
    if (!buffer) return std::nullopt;
    Bytes held = buffers_.of(document_, *buffer);
    for (const std::uint64_t begin :
         {gltfWhole(view, "byteOffset").value_or(0), gltfWhole(owner, "byteOffset").value_or(0)}) {
      if (begin > held.size()) return std::nullopt;
      held = held.subspan(static_cast<std::size_t>(begin));
    }
    const std::uint64_t stride = std::max(bytes, gltfWhole(view, "byteStride").value_or(bytes));
    if (count != 0 && (held.size() < bytes || (held.size() - bytes) / stride < count - 1)) {
      return std::nullopt;
    }
    return Elements{.bytes = held, .stride = static_cast<std::size_t>(stride)};
  }

  Json& document_;
  Buffers& buffers_;
  std::string floats_;
  /// Accessors of moved coordinates, by what they were made of.
  std::map<std::pair<std::uint64_t, UvTransform>, std::uint64_t> made_;
};

/// The file with another JSON.
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

/// Whether the JSON has anything that may ask for other coordinates: a look at the text is cheap.
bool mayDiffer(Bytes file) {
  const Bytes json = gltfJson(file);
  const std::string_view text(reinterpret_cast<const char*>(json.data()), json.size());
  constexpr std::array<std::string_view, 3> kCauses{"\"normalized\"", "\"texCoord\"",
                                                    "\"KHR_texture_transform\""};
  return std::ranges::any_of(kCauses,
                             [&](std::string_view cause) { return text.find(cause) != text.npos; });
}

}  // namespace

std::optional<DrawnGltf> drawnGltf(const fs::path& path, Bytes file, Reach reach) {
  if (!mayDiffer(file)) return std::nullopt;
  Json document = parseGltf(file);
  if (!document.is_object()) return std::nullopt;
  Buffers buffers(path, file, reach);
  CoordinateWriter writer(document, buffers);
  if (!writer.run()) return std::nullopt;
  return DrawnGltf{.file = withJson(file, document.dump()),
                   .texture_coordinates = writer.takeFloats()};
}

}  // namespace galactic::bake
