#include "import/gltf_json.h"

#include <algorithm>
#include <cstring>

namespace galactic::bake {

using Json = nlohmann::json;

std::uint32_t gltfWordAt(std::span<const std::byte> bytes, std::size_t offset) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + offset, sizeof(word));
  return word;
}

bool isGlb(std::span<const std::byte> file) {
  constexpr std::uint32_t kGlbMagic = 0x46546C67;
  return file.size() >= kGlbHeader + kGlbChunkHeader && gltfWordAt(file, 0) == kGlbMagic;
}

std::span<const std::byte> gltfJson(std::span<const std::byte> file) {
  if (!isGlb(file)) return file;
  const std::size_t length = gltfWordAt(file, kGlbHeader);
  const std::size_t start = kGlbHeader + kGlbChunkHeader;
  return file.subspan(start, std::min(length, file.size() - start));
}

std::span<const std::byte> gltfBehindJson(std::span<const std::byte> file) {
  if (!isGlb(file)) return {};
  return file.subspan(kGlbHeader + kGlbChunkHeader + gltfJson(file).size());
}

Json parseGltf(std::span<const std::byte> file) {
  const std::span<const std::byte> json = gltfJson(file);
  const auto* text = reinterpret_cast<const char*>(json.data());
  return Json::parse(text, text + json.size(), nullptr, /*allow_exceptions=*/false);
}

const Json& gltfList(const Json& document, const char* key) {
  static const Json none = Json::array();
  const auto list = document.find(key);
  return list == document.end() || !list->is_array() ? none : *list;
}

std::optional<std::uint64_t> gltfWhole(const Json& object, const char* key) {
  const auto member = object.find(key);
  if (member == object.end() || !member->is_number_unsigned()) return std::nullopt;
  return member->get<std::uint64_t>();
}

std::optional<std::uint64_t> gltfWhole(const Json& object, const char* key,
                                       std::uint64_t otherwise) {
  return object.contains(key) ? gltfWhole(object, key) : otherwise;
}

std::string gltfText(const Json& object, const char* key) {
  const auto member = object.find(key);
  return member == object.end() || !member->is_string() ? std::string()
                                                        : member->get<std::string>();
}

std::uint64_t gltfComponentBytes(std::uint64_t type) {
  switch (type) {
    case 5120:
    case 5121:
      return 1;
    case 5122:
    case 5123:
      return 2;
    case 5125:
    case 5126:
      return 4;
    default:
      return 0;
  }
}

}  // namespace galactic::bake
