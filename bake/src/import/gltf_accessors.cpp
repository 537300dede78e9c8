#include "import/gltf_accessors.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <utility>

#include "import/gltf_json.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Bytes = std::span<const std::byte>;

constexpr std::uint64_t kFloat = 5126;

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

template <class T>
double numberAt(const std::byte* at) {
  T value{};
  std::memcpy(&value, at, sizeof(T));
  return static_cast<double>(value);
}

/// The value of one component; `normalized` integers become 0 to 1, or -1 to 1.
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

const Json* memberObject(const Json& parent, const char* key) {
  const auto member = parent.find(key);
  return member != parent.end() && member->is_object() ? &*member : nullptr;
}

std::uint64_t componentType(const Json& owner) {
  return gltfWhole(owner, "componentType").value_or(0);
}

/// Copies the first numbers of an element of `accessor`.
void copyElement(const std::byte* from, const Json& accessor, std::span<double> to) {
  const std::uint64_t type = componentType(accessor);
  const auto member = accessor.find("normalized");
  const bool normalized = member != accessor.end() && *member == true;
  for (double& number : to) {
    number = componentAt(from, type, normalized);
    from += gltfComponentBytes(type);
  }
}

}  // namespace

GltfAccessors::GltfAccessors(Json& document, const fs::path& path, Bytes file, Reach reach)
    : document_(document), path_(path), file_(file), reach_(reach) {}

bool GltfAccessors::isFloat(std::uint64_t accessor) const {
  const Json& accessors = gltfList(document_, "accessors");
  return accessor < accessors.size() && gltfWhole(accessors[accessor], "componentType") == kFloat;
}

Result<std::optional<std::vector<double>>> GltfAccessors::read(std::uint64_t accessor,
                                                               std::uint64_t components) {
  const Json& accessors = gltfList(document_, "accessors");
  if (accessor >= accessors.size() || !accessors[accessor].is_object()) return std::nullopt;
  const Json& stated = accessors[accessor];
  const std::uint64_t bytes = components * gltfComponentBytes(componentType(stated));
  const auto count = gltfWhole(stated, "count");
  const bool fits = gltfText(stated, "type") == (components == 2 ? "VEC2" : "VEC3");
  if (!count || *count == 0 || bytes == 0 || !fits) return std::nullopt;
  std::vector<double> numbers(*count * components);
  if (stated.contains("bufferView")) {
    ASSIGN_OR_RETURN(const auto elements, elementsOf(stated, *count, bytes));
    if (!elements) return std::nullopt;
    for (std::uint64_t n = 0; n < *count; ++n) {
      copyElement(elements->at(n), stated, std::span(numbers).subspan(n * components, components));
    }
  }
  ASSIGN_OR_RETURN(const bool complete, replaceSparse(accessor, components, numbers));
  if (!complete) return std::nullopt;
  return numbers;
}

Result<bool> GltfAccessors::replaceSparse(std::uint64_t accessor, std::uint64_t components,
                                          std::vector<double>& numbers) {
  const Json& stated = gltfList(document_, "accessors")[accessor];
  const Json* sparse = memberObject(stated, "sparse");
  if (sparse == nullptr) return true;
  const Json* indices = memberObject(*sparse, "indices");
  const Json* values = memberObject(*sparse, "values");
  if (indices == nullptr || values == nullptr) return false;
  const std::uint64_t some = gltfWhole(*sparse, "count").value_or(0);
  ASSIGN_OR_RETURN(const auto places,
                   elementsOf(*indices, some, gltfComponentBytes(componentType(*indices))));
  ASSIGN_OR_RETURN(
      const auto replaced,
      elementsOf(*values, some, components * gltfComponentBytes(componentType(stated))));
  if (!places || !replaced) return false;
  const std::uint64_t count = numbers.size() / components;
  for (std::uint64_t n = 0; n < some; ++n) {
    const double place = componentAt(places->at(n), componentType(*indices), false);
    if (!(place >= 0 && place < static_cast<double>(count))) {
      return fail(ErrorCode::kInvalidInput, path_.string(),
                  fmt::format("accessor {} has a sparse element {}, and {} elements; the file is "
                              "damaged: export or download it again",
                              accessor, place, count));
    }
    const auto to = static_cast<std::uint64_t>(place);
    copyElement(replaced->at(n), stated, std::span(numbers).subspan(to * components, components));
  }
  return true;
}

std::uint64_t GltfAccessors::append(std::span<const double> numbers, std::uint64_t components) {
  constexpr auto kLargest = static_cast<double>(std::numeric_limits<float>::max());
  const std::size_t first = floats_.size();
  for (const double number : numbers) {
    const auto rounded = static_cast<float>(std::clamp(number, -kLargest, kLargest));
    floats_.append(reinterpret_cast<const char*>(&rounded), sizeof(rounded));
  }
  Json& views = document_["bufferViews"];
  views.push_back({{"buffer", document_["buffers"].size()},
                   {"byteOffset", first},
                   {"byteLength", floats_.size() - first}});
  Json& accessors = document_["accessors"];
  accessors.push_back({{"bufferView", views.size() - 1},
                       {"componentType", kFloat},
                       {"count", numbers.size() / components},
                       {"type", components == 2 ? "VEC2" : "VEC3"}});
  return accessors.size() - 1;
}

std::string GltfAccessors::finish(std::string_view uri) {
  if (!floats_.empty()) {
    document_["buffers"].push_back({{"uri", uri}, {"byteLength", floats_.size()}});
  }
  return std::move(floats_);
}

Bytes GltfAccessors::bufferAt(std::uint64_t number) {
  const Json& buffers = gltfList(document_, "buffers");
  if (number >= buffers.size()) return {};
  const auto uri = buffers[number].find("uri");
  if (uri == buffers[number].end()) return number == 0 ? ownBuffer() : Bytes();
  if (!uri->is_string()) return {};
  const auto [entry, is_new] = buffers_.try_emplace(number);
  if (is_new) entry->second = find(uri->get_ref<const std::string&>());
  if (entry->second.mapped) return entry->second.mapped->bytes();
  return std::as_bytes(std::span(entry->second.decoded));
}

Bytes GltfAccessors::ownBuffer() const {
  const Bytes chunk = gltfBehindJson(file_);
  if (chunk.size() < kGlbChunkHeader) return {};
  const std::size_t length = gltfWordAt(chunk, 0);
  return chunk.subspan(kGlbChunkHeader, std::min(length, chunk.size() - kGlbChunkHeader));
}

GltfAccessors::Buffer GltfAccessors::find(const std::string& uri) const {
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(',');
    if (comma == uri.npos) return {};
    const std::string_view data = std::string_view(uri).substr(comma + 1);
    const bool is_base64 = uri.substr(0, comma).ends_with(";base64");
    return {.mapped = std::nullopt, .decoded = is_base64 ? base64Decoded(data) : std::string(data)};
  }
  const fs::path folder = path_.parent_path();
  for (const std::string& name : {uri, withoutUriEscapes(uri)}) {
    if (reach_ == Reach::kNear && !isBelow(folder / name, folder)) continue;
    if (auto mapped = MappedFile::open(folder / name)) {
      return {.mapped = std::move(*mapped), .decoded = {}};
    }
  }
  return {};
}

Result<std::optional<GltfAccessors::Elements>> GltfAccessors::elementsOf(const Json& owner,
                                                                         std::uint64_t count,
                                                                         std::uint64_t bytes) {
  const Json& views = gltfList(document_, "bufferViews");
  const auto number = gltfWhole(owner, "bufferView");
  if (!number || *number >= views.size() || bytes == 0) return std::nullopt;
  const Json& view = views[*number];
  const auto buffer = gltfWhole(view, "buffer");
  if (!buffer) return std::nullopt;
  Bytes held = bufferAt(*buffer);
  if (held.empty()) return std::nullopt;
  const auto cut_off = [&, all = held.size()] {
    return fail(ErrorCode::kInvalidInput, path_.string(),
                fmt::format("only {} bytes of its buffer {} can be read, and buffer view {} takes "
                            "more; the file is damaged: export or download it again",
                            all, *buffer, *number));
  };
  for (const Json* one : {&view, &owner}) {
    const auto begin = gltfWhole(*one, "byteOffset", 0);
    if (!begin || *begin > held.size()) return cut_off();
    held = held.subspan(static_cast<std::size_t>(*begin));
  }
  const std::uint64_t stride = std::max(bytes, gltfWhole(view, "byteStride").value_or(bytes));
  if (count != 0 && (held.size() < bytes || (held.size() - bytes) / stride < count - 1)) {
    return cut_off();
  }
  return Elements{.bytes = held, .stride = static_cast<std::size_t>(stride)};
}

}  // namespace galactic::bake
