#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "common/lfs_pointer.h"
#include "import/checks/content_check.h"
#include "import/gltf_json.h"
#include "import/source_files.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::int64_t kTriangles = 4;
constexpr std::string_view kNoOffset = "a byteOffset that is no whole number from 0 on";

/// Number of components of one element of an accessor; 0 for an unknown type.
std::uint64_t componentsOf(std::string_view type) {
  constexpr std::array<std::pair<std::string_view, std::uint64_t>, 7> kTypes{{{"SCALAR", 1},
                                                                              {"VEC2", 2},
                                                                              {"VEC3", 3},
                                                                              {"VEC4", 4},
                                                                              {"MAT2", 4},
                                                                              {"MAT3", 9},
                                                                              {"MAT4", 16}}};
  const auto* found = std::find_if(kTypes.begin(), kTypes.end(),
                                   [&](const auto& one) { return one.first == type; });
  return found == kTypes.end() ? 0 : found->second;
}

/// Number of bytes that the data URI holds: four characters of base64 encode three.
std::uint64_t decodedBytes(std::string_view uri) {
  const std::size_t comma = uri.find(',');
  if (comma == uri.npos) return 0;
  std::string_view data = uri.substr(comma + 1);
  if (!uri.substr(0, comma).ends_with(";base64")) return data.size();
  while (data.ends_with('=')) data.remove_suffix(1);
  return data.size() / 4 * 3 + data.size() % 4 * 3 / 4;
}

class GltfRanges {
 public:
  GltfRanges(const fs::path& path, const Json& document, std::uint64_t binary_bytes)
      : path_(path), document_(document), binary_bytes_(binary_bytes) {
    for (const Json& accessor : listOf("accessors")) {
      if (!accessor.is_object() || !accessor.contains("bufferView")) continue;
      most_elements_ = std::max(most_elements_, gltfWhole(accessor, "count").value_or(0));
    }
  }

  Result<void> check() const {
    const auto each = [this](const char* list, auto&& judge) -> Result<void> {
      const Json& items = listOf(list);
      for (std::size_t n = 0; n < items.size(); ++n) {
        if (!items[n].is_object()) continue;
        if (auto checked = judge(items[n], n); !checked) return checked;
      }
      return {};
    };
    if (auto checked = each("buffers", [&](auto& item, auto n) { return checkBuffer(item, n); });
        !checked) {
      return checked;
    }
    if (auto checked = each("bufferViews", [&](auto& item, auto n) { return checkView(item, n); });
        !checked) {
      return checked;
    }
    if (auto checked =
            each("accessors", [&](auto& item, auto n) { return checkAccessor(item, n); });
        !checked) {
      return checked;
    }
    return each("meshes", [&](auto& item, auto n) { return checkMesh(item, n); });
  }

 private:
  [[nodiscard]] tl::unexpected<Error> broken(const std::string& message) const {
    return fail(ErrorCode::kInvalidInput, path_.string(),
                message + "; the file is cut off or damaged: export or download it again");
  }

  [[nodiscard]] const Json& listOf(const char* key) const { return gltfList(document_, key); }

  [[nodiscard]] Result<void> checkBuffer(const Json& buffer, std::size_t n) const {
    const auto stated = gltfWhole(buffer, "byteLength");
    if (!stated) return broken(fmt::format("buffer {} has no byteLength", n));
    const std::string uri = gltfText(buffer, "uri");
    std::optional<std::uint64_t> found = binary_bytes_;
    if (uri.starts_with("data:")) {
      found = decodedBytes(uri);
    } else if (!uri.empty()) {
      found = bytesOfFile(uri);
    } else if (n > 0) {
      // Only the first buffer is the GLB's own; others without a URI belong to extensions.
      return {};
    }
    // If the file does not exist, the reader reports it.
    if (!found || *found >= *stated) return {};
    if (!uri.empty() && isLfsPointer(path_.parent_path() / withoutUriEscapes(uri))) {
      return fail(ErrorCode::kInvalidInput, path_.string(),
                  fmt::format("its buffer '{}' is {}", uri, kLfsPointer));
    }
    return broken(fmt::format("buffer {} states {} bytes and has {}", n, *stated, *found));
  }

  [[nodiscard]] std::optional<std::uint64_t> bytesOfFile(const std::string& uri) const {
    for (const std::string& name : {uri, withoutUriEscapes(uri)}) {
      std::error_code problem;
      const auto bytes = fs::file_size(path_.parent_path() / name, problem);
      if (!problem) return bytes;
    }
    return std::nullopt;
  }

  [[nodiscard]] Result<void> checkView(const Json& view, std::size_t n) const {
    const Json& buffers = listOf("buffers");
    const auto buffer = gltfWhole(view, "buffer");
    const auto length = gltfWhole(view, "byteLength");
    if (!buffer || *buffer >= buffers.size() || !length) {
      return broken(fmt::format("buffer view {} has no buffer or no byteLength", n));
    }
    const std::uint64_t all = gltfWhole(buffers[*buffer], "byteLength").value_or(0);
    const auto begin = gltfWhole(view, "byteOffset", 0);
    if (!begin) return broken(fmt::format("buffer view {} has {}", n, kNoOffset));
    if (*begin <= all && *length <= all - *begin) return {};
    return broken(fmt::format("buffer view {} is {} bytes from {} on, and its buffer has {}", n,
                              *length, *begin, all));
  }

  /// Checks that `count` elements of `bytes` bytes each fit into the buffer view that `owner`
  /// names.
  [[nodiscard]] Result<void> checkFits(const Json& owner, std::uint64_t count, std::uint64_t bytes,
                                       const std::string& what) const {
    const Json& views = listOf("bufferViews");
    const auto index = gltfWhole(owner, "bufferView");
    if (!index || *index >= views.size() || !views[*index].is_object()) {
      return broken(fmt::format("{} uses buffer view {}, and there are {}", what,
                                owner.value("bufferView", Json()).dump(), views.size()));
    }
    const std::uint64_t all = gltfWhole(views[*index], "byteLength").value_or(0);
    const auto begin = gltfWhole(owner, "byteOffset", 0);
    if (!begin) return broken(fmt::format("{} has {}", what, kNoOffset));
    const std::uint64_t stride =
        std::max(bytes, gltfWhole(views[*index], "byteStride").value_or(bytes));
    const std::uint64_t room = all < *begin ? 0 : all - *begin;
    const std::uint64_t held = room < bytes ? 0 : (room - bytes) / stride + 1;
    if (held >= count) return {};
    return broken(
        fmt::format("{} states {} elements, and its buffer view holds {}", what, count, held));
  }

  [[nodiscard]] Result<void> checkAccessor(const Json& accessor, std::size_t n) const {
    const std::string what = fmt::format("accessor {}", n);
    const auto count = gltfWhole(accessor, "count");
    const std::uint64_t component =
        gltfComponentBytes(gltfWhole(accessor, "componentType").value_or(0));
    const std::uint64_t bytes = component * componentsOf(gltfText(accessor, "type"));
    if (!count || bytes == 0) return broken(what + " has no count, componentType or type");
    if (accessor.contains("bufferView")) {
      RETURN_IF_ERROR(checkFits(accessor, *count, bytes, what));
    } else if (*count > most_elements_) {
      return broken(
          fmt::format("{} states {} elements without a buffer view, and the largest with "
                      "one has {}",
                      what, *count, most_elements_));
    }
    const auto sparse = accessor.find("sparse");
    if (sparse == accessor.end() || !sparse->is_object()) return {};
    const auto some = gltfWhole(*sparse, "count");
    if (!some) return broken(what + " is sparse without a count");
    const auto part = [&](const char* key) -> Result<const Json*> {
      const auto found = sparse->find(key);
      if (found == sparse->end() || !found->is_object()) {
        return broken(what + " is sparse without " + key);
      }
      return &*found;
    };
    ASSIGN_OR_RETURN(const Json* indices, part("indices"));
    ASSIGN_OR_RETURN(const Json* values, part("values"));
    const std::uint64_t index_bytes =
        gltfComponentBytes(gltfWhole(*indices, "componentType").value_or(0));
    if (index_bytes == 0) return broken(what + " has sparse indices without a componentType");
    RETURN_IF_ERROR(checkFits(*indices, *some, index_bytes, what + " sparse indices"));
    return checkFits(*values, *some, bytes, what + " sparse values");
  }

  [[nodiscard]] Result<void> checkMesh(const Json& mesh, std::size_t n) const {
    const auto primitives = mesh.find("primitives");
    if (primitives == mesh.end() || !primitives->is_array()) return {};
    for (std::size_t p = 0; p < primitives->size(); ++p) {
      if (!(*primitives)[p].is_object()) continue;
      const std::string what = fmt::format("primitive {} of mesh {}", p, n);
      if (auto checked = checkPrimitive((*primitives)[p], what); !checked) return checked;
    }
    return {};
  }

  /// The count of an accessor; none if there is no such accessor.
  [[nodiscard]] std::optional<std::uint64_t> countOf(const Json& index) const {
    const Json& accessors = listOf("accessors");
    if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= accessors.size()) {
      return std::nullopt;
    }
    const Json& accessor = accessors[index.get<std::size_t>()];
    return accessor.is_object() ? gltfWhole(accessor, "count") : std::nullopt;
  }

  /// Checks the attributes of a primitive, or of a morph target.
  [[nodiscard]] Result<void> checkAttributes(const Json& attributes, std::uint64_t vertices,
                                             const std::string& what) const {
    if (!attributes.is_object()) return {};
    for (const auto& attribute : attributes.items()) {
      const auto count = countOf(attribute.value());
      if (count != vertices) {
        return broken(fmt::format("{} has {} positions and {} of {}", what, vertices,
                                  count.value_or(0), attribute.key()));
      }
      if (attribute.key() != "POSITION") continue;
      const auto number = attribute.value().get<std::size_t>();
      const std::string type = gltfText(listOf("accessors")[number], "type");
      if (type == "VEC3") continue;
      return broken(
          fmt::format("{} has its positions in accessor {}, whose type is {}, expected "
                      "VEC3",
                      what, number, type));
    }
    return {};
  }

  [[nodiscard]] Result<void> checkPrimitive(const Json& primitive, const std::string& what) const {
    const auto attributes = primitive.find("attributes");
    if (attributes == primitive.end() || !attributes->is_object()) return {};
    const auto position = attributes->find("POSITION");
    if (position == attributes->end()) return {};
    const auto vertices = countOf(*position);
    if (!vertices) return broken(what + " uses an accessor that is not there");
    RETURN_IF_ERROR(checkAttributes(*attributes, *vertices, what));
    const Json& accessor = listOf("accessors")[position->get<std::size_t>()];
    if (!accessor.contains("bufferView") && !accessor.contains("sparse")) {
      return broken(
          fmt::format("{} has its positions in accessor {}, which has neither a "
                      "bufferView nor sparse elements",
                      what, position->dump()));
    }
    const auto targets = primitive.find("targets");
    if (targets != primitive.end() && targets->is_array()) {
      for (std::size_t n = 0; n < targets->size(); ++n) {
        const std::string target = fmt::format("{} (morph target {})", what, n);
        RETURN_IF_ERROR(checkAttributes((*targets)[n], *vertices, target));
      }
    }
    const auto indices = primitive.find("indices");
    const auto corners = indices == primitive.end() ? vertices : countOf(*indices);
    if (!corners) return broken(what + " uses an accessor that is not there");
    const auto mode = gltfWhole(primitive, "mode").value_or(kTriangles);
    if (mode != kTriangles || *corners % 3 == 0) return {};
    return broken(
        fmt::format("{} has {} corners of triangles, expected three of each", what, *corners));
  }

  const fs::path& path_;
  const Json& document_;
  std::uint64_t binary_bytes_;
  /// The most elements of any accessor that has a buffer view, and thus bytes. An accessor without
  /// one is all zeros and has as many elements as another of its mesh.
  std::uint64_t most_elements_ = 0;
};

/// Length of the GLB's own buffer, which is the chunk after the JSON; 0 for other files.
Result<std::uint64_t> binaryBytes(const fs::path& path, std::span<const std::byte> file) {
  if (!isGlb(file)) return 0;
  const auto cut_off = [&](std::uint64_t stated, const char* what) {
    return fail(ErrorCode::kInvalidInput, path.string(),
                fmt::format("{} states {} bytes and {} are there; the file is cut off: export or "
                            "download it again",
                            what, stated, file.size()));
  };
  const std::uint64_t all = gltfWordAt(file, 8);
  if (all > file.size()) return cut_off(all, "its GLB header");
  const std::uint64_t json_end =
      kGlbHeader + kGlbChunkHeader + std::uint64_t{gltfWordAt(file, kGlbHeader)};
  if (json_end > all) return cut_off(json_end, "its JSON chunk");
  if (json_end + kGlbChunkHeader > all) return 0;
  const std::uint64_t binary = gltfWordAt(file, static_cast<std::size_t>(json_end));
  if (json_end + kGlbChunkHeader + binary > all) {
    return cut_off(json_end + kGlbChunkHeader + binary, "its binary chunk");
  }
  return binary;
}

}  // namespace

Result<void> checkGltfRanges(const fs::path& path, std::span<const std::byte> bytes) {
  ASSIGN_OR_RETURN(const auto binary, binaryBytes(path, bytes));
  const Json document = parseGltf(bytes);
  if (!document.is_object()) return {};
  return GltfRanges(path, document, binary).check();
}

}  // namespace galactic::bake
