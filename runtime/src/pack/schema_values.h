#pragma once
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "galactic/pose.h"
#include "galactic/schema/pack_generated.h"
#include "galactic/shapes.h"

namespace galactic::detail {

// Plain structs of the runtime have the same layout as those of the schema, so that vectors are
// read in place.
static_assert(sizeof(Vec3) == sizeof(schema::Vec3));
static_assert(sizeof(Quat) == sizeof(schema::Quat));
static_assert(sizeof(Pose) == sizeof(schema::Pose));
static_assert(sizeof(SetSphere) == sizeof(schema::SetSphere));

[[nodiscard]] inline Vec3 fromSchema(const schema::Vec3& v) { return {v.x(), v.y(), v.z()}; }

[[nodiscard]] inline Quat fromSchema(const schema::Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }

[[nodiscard]] inline Pose fromSchema(const schema::Pose& pose) {
  return {fromSchema(pose.translation()), fromSchema(pose.rotation())};
}

[[nodiscard]] inline std::string_view fromSchema(const flatbuffers::String* text) {
  return {text->c_str(), text->size()};
}

/// Views of a list of names.
[[nodiscard]] inline std::vector<std::string_view> namesOf(
    const flatbuffers::Vector<flatbuffers::Offset<flatbuffers::String>>& stored) {
  std::vector<std::string_view> names;
  names.reserve(stored.size());
  for (const flatbuffers::String* name : stored) names.push_back(fromSchema(name));
  return names;
}

/// A vector of schema structs, in place, as the runtime's structs of the same layout.
template <class T, class Stored>
[[nodiscard]] std::span<const T> inPlace(const flatbuffers::Vector<Stored>* vector) {
  return {reinterpret_cast<const T*>(vector->Data()), vector->size()};
}

}  // namespace galactic::detail
