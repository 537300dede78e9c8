#pragma once
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "galactic/pack.h"
#include "galactic/schema/pack_generated.h"
#include "support/scene_pack_builder.h"

namespace galactic::test {

/// One object of a small pack; a test changes what it wants to differ.
struct ToyObject {
  std::string name = "block";
  /// Of an axis-aligned block around the object's origin, metres.
  Vec3 half{0.05F, 0.1F, 0.03F};
  std::vector<schema::SetSphere> spheres{{schema::Vec3(0, 0.02F, 0), 1},
                                         {schema::Vec3(0, -0.06F, 0), 0}};
  bool coloured = false;
  double gap = 0.012;
};

struct ToyObjects {
  std::vector<ToyObject> objects{{}, {.name = "die", .half = {0.01F, 0.01F, 0.01F}}};
  std::string tool_version = "0.1.0";
  RenderMeshesField render_meshes = {};
};

/// A robot of five links: base -> upper (revolute) -> slide (prismatic, no limits) -> finger
/// (mimics upper), and a fixed head on the base.
struct ToyRobot {
  std::string name = "arm";
  float upper_limit = 2;
  /// base_from_upper where the joint is at 0.
  schema::Quat upper_rotation{0.5F, 0.5F, 0.5F, 0.5F};
  std::vector<schema::SetSphere> base_spheres{{schema::Vec3(0, 0.2F, 0), 1},
                                              {schema::Vec3(0.125F, 0.5F, -0.25F), 0}};
  bool with_recipe = true;
  RenderMeshesField render_meshes = {};
};

/// Makes packs of toys.
class ToyPackBuilder {
 public:
  static AlignedBytes build(const ToyObjects& toys) {
    ToyPackBuilder maker;
    const auto asset = maker.objectSet(toys).Union();
    return maker.finish(PackKind::kObjects, schema::Asset::ObjectSet, asset, toys.tool_version);
  }

  static AlignedBytes build(const ToyRobot& toy) {
    ToyPackBuilder maker;
    const auto asset = maker.robot(toy).Union();
    return maker.finish(PackKind::kRobot, schema::Asset::Robot, asset, "0.1.0");
  }

 private:
  AlignedBytes finish(PackKind kind, schema::Asset type, flatbuffers::Offset<void> asset,
                      const std::string& version) {
    const auto provenance = schema::CreateProvenance(
        fbb_, fbb_.CreateString("galactic-bake"), fbb_.CreateString(version),
        fbb_.CreateVector(std::vector<flatbuffers::Offset<schema::Option>>{}),
        fbb_.CreateVector(std::vector<flatbuffers::Offset<schema::SourceFile>>{}),
        fbb_.CreateVector(std::vector<flatbuffers::Offset<flatbuffers::String>>{}));
    schema::FinishPackBuffer(fbb_, schema::CreatePack(fbb_, provenance, type, asset));
    return ScenePackBuilder::withHeader(
        kind, {reinterpret_cast<const std::byte*>(fbb_.GetBufferPointer()), fbb_.GetSize()});
  }

  template <class T>
  auto structs(const std::vector<T>& values) {
    fbb_.ForceVectorAlignment(values.size(), sizeof(T), 32);
    return fbb_.CreateVectorOfStructs(values);
  }

  template <class T>
  auto numbers(const std::vector<T>& values) {
    fbb_.ForceVectorAlignment(values.size(), sizeof(T), 32);
    return fbb_.CreateVector(values);
  }

  auto names(const std::vector<std::string>& texts) { return fbb_.CreateVectorOfStrings(texts); }

  /// A block around the origin as 12 triangles that face outwards.
  flatbuffers::Offset<schema::Surface> block(const Vec3& half, bool coloured) {
    std::vector<schema::Vec3> corners;
    for (unsigned n = 0; n < 8; ++n) {
      corners.emplace_back((n & 1U) != 0 ? half.x : -half.x, (n & 2U) != 0 ? half.y : -half.y,
                           (n & 4U) != 0 ? half.z : -half.z);
    }
    const std::vector<std::uint32_t> triangles{0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5,
                                               0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3,
                                               0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
    const auto positions = structs(corners);
    const auto indices = numbers(triangles);
    // Pure red.
    const auto colors =
        numbers(std::vector<std::uint32_t>(coloured ? corners.size() : 0, 0xff0000ffU));
    return schema::CreateSurface(fbb_, positions, indices, colors);
  }

  flatbuffers::Offset<schema::SphereSetStatistics> quality(double gap) {
    const schema::LengthStatistics gaps(gap / 4, gap / 2, gap);
    const schema::LengthStatistics protrusions(0.001, 0.002, 0.004);
    return schema::CreateSphereSetStatistics(fbb_, 0.015F, 0.02F, &gaps, &protrusions, 0.9, 3, 1000,
                                             0.015, 0.02, true, false);
  }

  flatbuffers::Offset<schema::Object> object(const ToyObject& toy) {
    const Vec3& h = toy.half;
    const auto name = fbb_.CreateString(toy.name);
    const auto spheres = structs(toy.spheres);
    const auto poses = structs(std::vector{schema::StablePose(no_turn_, h.y, 0.75F),
                                           schema::StablePose({1, 0, 0, 0}, h.y, 0.25F)});
    const auto import =
        schema::CreateImportStatistics(fbb_, fbb_.CreateString("toy"), 1, 1, 12, 0, 0, 12);
    const auto surface = block(h, toy.coloured);
    const auto statistics = quality(toy.gap);
    const schema::Pose box_pose({0, 0, 0}, no_turn_);
    const schema::Vec3 half(h.x, h.y, h.z);
    const schema::BoxStatistics volumes(1e-3, 2e-3, 1.5e-3);
    const schema::Bounds bounds({-h.x, -h.y, -h.z}, half);
    return schema::CreateObject(fbb_, name, &box_pose, &half, schema::BoxFit::Yaw, &volumes,
                                spheres, statistics, poses, &bounds, import, surface);
  }

  flatbuffers::Offset<schema::ObjectSet> objectSet(const ToyObjects& toys) {
    std::vector<flatbuffers::Offset<schema::Object>> objects;
    for (const ToyObject& toy : toys.objects) objects.push_back(object(toy));
    const auto radii = fbb_.CreateVector(std::vector<float>{0.015F, 0.05F});
    const auto stored = fbb_.CreateVector(objects);
    return schema::CreateObjectSet(fbb_, radii, stored,
                                   buildRenderMeshesField(fbb_, toys.render_meshes));
  }

  [[nodiscard]] std::vector<schema::LinkFrame> links(const schema::Quat& upper_rotation) const {
    using schema::JointType;
    const schema::Pose none({0, 0, 0}, no_turn_);
    const schema::Vec3 x(1, 0, 0);
    const schema::Vec3 z(0, 0, 1);
    return {
        {none, x, -1, -1, 1, 0, JointType::Fixed},
        {{{0, 1, 0.25F}, upper_rotation}, z, 0, 0, 1, 0, JointType::Revolute},
        {{{0.5F, 0, 0}, no_turn_}, x, 1, 1, 1, 0, JointType::Prismatic},
        {{{0.25F, 0, 0}, no_turn_}, z, 2, 0, -0.5F, 0.125F, JointType::Revolute},
        {{{0, 2, 0}, no_turn_}, x, 0, -1, 1, 0, JointType::Fixed},
    };
  }

  flatbuffers::Offset<schema::SphereGroup> group(std::vector<std::uint32_t> members,
                                                 std::uint32_t first, std::uint32_t count) {
    const auto stored = fbb_.CreateVector(members);
    const auto statistics =
        count > 0 ? quality(0.02) : flatbuffers::Offset<schema::SphereSetStatistics>();
    return schema::CreateSphereGroup(fbb_, members.front(), stored, first, count, statistics);
  }

  flatbuffers::Offset<schema::Robot> robot(const ToyRobot& toy) {
    using schema::PairKind;
    constexpr float kFree = std::numeric_limits<float>::max();
    std::vector<schema::SetSphere> spheres = toy.base_spheres;
    const auto base_count = static_cast<std::uint32_t>(spheres.size());
    spheres.emplace_back(schema::Vec3(0.25F, 0, 0), 0);
    spheres.emplace_back(schema::Vec3(0, 0, 0), 0);
    const auto name = fbb_.CreateString(toy.name);
    const auto radii = fbb_.CreateVector(std::vector<float>{0.05F, 0.25F});
    const auto frames = structs(links(toy.upper_rotation));
    const auto link_names = names({"base", "upper", "slide", "finger", "head"});
    const auto joint_names = names({"", "lift", "reach", "grip", "neck"});
    const auto limits = structs(std::vector{schema::PositionLimits(-1, toy.upper_limit),
                                            schema::PositionLimits(-kFree, kFree)});
    const auto start = numbers(std::vector<float>{0.5F, 0.25F});
    const auto stored_spheres = structs(spheres);
    const auto groups = fbb_.CreateVector(
        std::vector{group({0, 4}, 0, base_count), group({1}, base_count, 1),
                    group({2}, base_count + 1, 1), group({3}, base_count + 2, 0)});
    const auto pairs = fbb_.CreateVectorOfStructs(std::vector{
        schema::GroupPair(0, 1, PairKind::Adjacent), schema::GroupPair(0, 2, PairKind::Tested),
        schema::GroupPair(1, 2, PairKind::Never)});
    const auto surfaces = fbb_.CreateVector(
        std::vector{schema::CreateLinkSurface(fbb_, 0, block({0.25F, 0.125F, 0.25F}, false),
                                              block({0.25F, 0.125F, 0.25F}, true)),
                    schema::CreateLinkSurface(fbb_, 1, block({0.125F, 0.0625F, 0.0625F}, false))});
    const auto render_meshes = buildRenderMeshesField(fbb_, toy.render_meshes);
    if (!toy.with_recipe) {
      const auto none = fbb_.CreateVectorOfStructs(std::vector<schema::ControlledJoint>{});
      return schema::CreateRobot(fbb_, name, radii, frames, link_names, joint_names, limits, start,
                                 stored_spheres, groups, pairs, none, 0, 0, 0, surfaces,
                                 render_meshes);
    }
    const auto controlled = fbb_.CreateVectorOfStructs(
        std::vector{schema::ControlledJoint(0, 0.1F, -1, toy.upper_limit)});
    const schema::Vec3 grasp(0.125F, 0, 0);
    const auto effector = schema::CreateEndEffector(fbb_, 2, &grasp, 0.0625F);
    const schema::Pose eye({0.25F, 0, 0}, no_turn_);
    const auto camera = schema::CreateCamera(fbb_, 4, &eye, 1);
    const schema::Vec3 low(-0.25F, 0, -0.25F);
    const schema::Vec3 high(0.25F, 0, 0.25F);
    const auto base = schema::CreateBase(fbb_, 0.1F, 0.2F, 0.5F, &low, &high, 0);
    return schema::CreateRobot(fbb_, name, radii, frames, link_names, joint_names, limits, start,
                               stored_spheres, groups, pairs, controlled, effector, camera, base,
                               surfaces, render_meshes);
  }

  const schema::Quat no_turn_{0, 0, 0, 1};
  flatbuffers::FlatBufferBuilder fbb_;
};

/// A pack in memory and the bytes that it looks into.
class ToyPack {
 public:
  template <class Toy>
  explicit ToyPack(const Toy& toy) : bytes_(ToyPackBuilder::build(toy)) {
    auto opened = PackFile::view(bytes_.bytes(), "toys.pack");
    if (opened) {
      pack_.emplace(std::move(*opened));
    } else {
      ADD_FAILURE() << opened.error().where << ": " << opened.error().message;
    }
  }

  [[nodiscard]] const PackFile& operator*() const { return *pack_; }

 private:
  AlignedBytes bytes_;
  std::optional<PackFile> pack_;
};

}  // namespace galactic::test
