#include "pack_tool/describe/json_parts.h"

#include <fmt/format.h>

#include "support/content_hash.h"

namespace galactic::pack_tool {

namespace {

Json describeLengths(const schema::LengthStatistics* lengths) {
  if (lengths == nullptr) return nullptr;
  return {{"mean", lengths->mean()}, {"p95", lengths->p95()}, {"max", lengths->max()}};
}

constexpr std::uint64_t kHashStart = 0xcbf29ce484222325;

/// FNV-1a, 64 bits, continued over more bytes.
std::uint64_t hashed(std::uint64_t hash, const std::uint8_t* bytes, std::size_t count) {
  constexpr std::uint64_t kPrime = 0x100000001b3;
  for (std::size_t n = 0; n < count; ++n) hash = (hash ^ bytes[n]) * kPrime;
  return hash;
}

}  // namespace

Json describePoint(const Vec3& point) {
  return Json::array({jsonNumber(point.x), jsonNumber(point.y), jsonNumber(point.z)});
}

Json describePoint(const schema::Vec3& point) {
  return Json::array({jsonNumber(point.x()), jsonNumber(point.y()), jsonNumber(point.z())});
}

Json describeRotation(const schema::Quat& rotation) {
  return Json::array({jsonNumber(rotation.w()), jsonNumber(rotation.x()), jsonNumber(rotation.y()),
                      jsonNumber(rotation.z())});
}

Json describePose(const schema::Pose& pose) {
  return {{"translation", describePoint(pose.translation())},
          {"rotation_wxyz", describeRotation(pose.rotation())}};
}

Json describeImport(const schema::ImportStatistics& statistics) {
  Json json;
  json["format"] = statistics.format()->str();
  json["meshes"] = statistics.meshes();
  json["instances"] = statistics.instances();
  json["triangles_read"] = statistics.triangles_read();
  json["triangles_degenerate"] = statistics.triangles_degenerate();
  json["triangles_duplicate"] = statistics.triangles_duplicate();
  json["triangles"] = statistics.triangles();
  return json;
}

Json describeRadii(const flatbuffers::Vector<float>& radii) {
  Json json = Json::array();
  for (const float radius : radii) json.push_back(jsonNumber(radius));
  return json;
}

Json describeSpheres(const flatbuffers::Vector<const schema::SetSphere*>& spheres,
                     const SphereRange& range, const flatbuffers::Vector<float>& radii) {
  Json json = Json::array();
  for (std::size_t n = range.first; n < range.first + range.count; ++n) {
    const schema::SetSphere& sphere = *spheres.Get(static_cast<flatbuffers::uoffset_t>(n));
    json.push_back({{"center", describePoint(sphere.center())},
                    {"radius", jsonNumber(radii.Get(sphere.radius_index()))}});
  }
  return json;
}

Json describeQuality(const schema::SphereSetStatistics* statistics) {
  if (statistics == nullptr) return nullptr;
  Json json;
  json["eps"] = jsonNumber(statistics->eps());
  json["tau"] = jsonNumber(statistics->tau());
  json["gap"] = describeLengths(statistics->gap());
  json["protrusion"] = describeLengths(statistics->protrusion());
  json["volume_ratio"] = statistics->volume_ratio();
  json["thin_points"] = statistics->thin_points();
  json["samples"] = statistics->samples();
  json["guaranteed_gap"] = statistics->guaranteed_gap();
  json["guaranteed_protrusion"] = statistics->guaranteed_protrusion();
  json["meets_tolerances"] = statistics->meets_tolerances();
  json["authored"] = statistics->authored();
  return json;
}

Json describeSurface(const schema::Surface* surface) {
  if (surface == nullptr) return nullptr;
  const auto bytes_of = [](std::uint64_t hash, const auto& values, std::size_t element) {
    return hashed(hash, values.Data(), values.size() * element);
  };
  std::uint64_t hash = bytes_of(kHashStart, *surface->positions(), sizeof(schema::Vec3));
  hash = bytes_of(hash, *surface->triangles(), sizeof(std::uint32_t));
  hash = bytes_of(hash, *surface->colors(), sizeof(std::uint32_t));
  return {{"vertices", surface->positions()->size()},
          {"triangles", surface->triangles()->size() / 3},
          {"colored", surface->colors()->size() > 0},
          {"fnv1a_64", fmt::format("{:016x}", hash)}};
}

std::string contentHash(std::span<const std::byte> bytes) {
  const auto* first = reinterpret_cast<const std::uint8_t*>(bytes.data());
  return fmt::format("{:016x}", hashed(kHashStart, first, bytes.size()));
}

Json describeHash(const schema::Hash128* hash) {
  if (hash == nullptr) return nullptr;
  return detail::hexOf({hash->low(), hash->high()});
}

Json describeTexts(const flatbuffers::Vector<flatbuffers::Offset<flatbuffers::String>>& texts) {
  Json list = Json::array();
  for (const flatbuffers::String* text : texts) list.push_back(text->str());
  return list;
}

}  // namespace galactic::pack_tool
