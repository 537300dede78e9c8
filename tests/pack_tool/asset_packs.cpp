#include "pack_tool/asset_packs.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <utility>

#include "support/packs/schema_parts.h"

namespace galactic::test {
namespace {

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
    return packFile(kind,
                    {reinterpret_cast<const std::byte*>(fbb_.GetBufferPointer()), fbb_.GetSize()});
  }

  auto names(const std::vector<std::string>& texts) { return fbb_.CreateVectorOfStrings(texts); }

  /// A block around the origin as 12 triangles that face outwards.
  flatbuffers::Offset<schema::Surface> block(const Vec3& half, bool colored) {
    std::vector<schema::Vec3> corners;
    for (unsigned n = 0; n < 8; ++n) {
      corners.emplace_back((n & 1U) != 0 ? half.x : -half.x, (n & 2U) != 0 ? half.y : -half.y,
                           (n & 4U) != 0 ? half.z : -half.z);
    }
    const std::vector<std::uint32_t> triangles{0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5,
                                               0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3,
                                               0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
    const auto positions = alignedStructs(fbb_, corners);
    const auto indices = alignedNumbers(fbb_, triangles);
    // Pure red.
    const auto colors =
        alignedNumbers(fbb_, std::vector<std::uint32_t>(colored ? corners.size() : 0, 0xff0000ffU));
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
    const auto spheres = buildSpheres(fbb_, toy.spheres);
    const auto poses =
        alignedStructs(fbb_, std::vector{schema::StablePose(no_turn_, h.y, 0.75F),
                                         schema::StablePose({1, 0, 0, 0}, h.y, 0.25F)});
    const auto import =
        schema::CreateImportStatistics(fbb_, fbb_.CreateString("toy"), 1, 1, 12, 0, 0, 12);
    const auto surface = block(h, toy.colored);
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
    const auto list = fbb_.CreateVector(objects);
    return schema::CreateObjectSet(fbb_, radii, list,
                                   buildRenderMeshesField(fbb_, toys.render_meshes));
  }

  [[nodiscard]] std::vector<schema::LinkFrame> links(const Quat& upper_rotation) const {
    using schema::JointType;
    const schema::Pose none({0, 0, 0}, no_turn_);
    const schema::Vec3 x(1, 0, 0);
    const schema::Vec3 z(0, 0, 1);
    return {
        {none, x, -1, -1, 1, 0, JointType::Fixed},
        {{{0, 1, 0.25F}, stored(upper_rotation)}, z, 0, 0, 1, 0, JointType::Revolute},
        {{{0.5F, 0, 0}, no_turn_}, x, 1, 1, 1, 0, JointType::Prismatic},
        {{{0.25F, 0, 0}, no_turn_}, z, 2, 0, -0.5F, 0.125F, JointType::Revolute},
        {{{0, 2, 0}, no_turn_}, x, 0, -1, 1, 0, JointType::Fixed},
    };
  }

  flatbuffers::Offset<schema::SphereGroup> group(std::vector<std::uint32_t> members,
                                                 std::uint32_t first, std::uint32_t count) {
    const auto list = fbb_.CreateVector(members);
    const auto statistics =
        count > 0 ? quality(0.02) : flatbuffers::Offset<schema::SphereSetStatistics>();
    return schema::CreateSphereGroup(fbb_, members.front(), list, first, count, statistics);
  }

  flatbuffers::Offset<schema::Robot> robot(const ToyRobot& toy) {
    using schema::PairKind;
    constexpr float kFree = std::numeric_limits<float>::max();
    std::vector<SetSphere> spheres = toy.base_spheres;
    const auto base_count = static_cast<std::uint32_t>(spheres.size());
    spheres.push_back({{0.25F, 0, 0}, 0});
    spheres.push_back({{0, 0, 0}, 0});
    const auto name = fbb_.CreateString(toy.name);
    const auto radii = fbb_.CreateVector(std::vector<float>{0.05F, 0.25F});
    const auto frames = alignedStructs(fbb_, links(toy.upper_rotation));
    const auto link_names = names({"base", "upper", "slide", "finger", "head"});
    const auto joint_names = names({"", "lift", "reach", "grip", "neck"});
    const auto limits =
        alignedStructs(fbb_, std::vector{schema::PositionLimits(-1, toy.upper_limit),
                                         schema::PositionLimits(-kFree, kFree)});
    const auto start = alignedNumbers(fbb_, std::vector<float>{0.5F, 0.25F});
    const auto stored_spheres = buildSpheres(fbb_, spheres);
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
    const schema::Pose low_ahead({0.25F, 0.125F, 0}, no_turn_);
    const auto laser = schema::CreateLaser(fbb_, 0, &low_ahead, 4, 0.0625F, 8, 0.015625F);
    return schema::CreateRobot(fbb_, name, radii, frames, link_names, joint_names, limits, start,
                               stored_spheres, groups, pairs, controlled, effector, camera, base,
                               surfaces, render_meshes, laser);
  }

  const schema::Quat no_turn_{0, 0, 0, 1};
  flatbuffers::FlatBufferBuilder fbb_;
};

}  // namespace

AlignedBytes buildPack(const ToyObjects& toys) { return ToyPackBuilder::build(toys); }
AlignedBytes buildPack(const ToyRobot& toy) { return ToyPackBuilder::build(toy); }

ToyPack::ToyPack(const ToyObjects& toys) : ToyPack(buildPack(toys)) {}
ToyPack::ToyPack(const ToyRobot& toy) : ToyPack(buildPack(toy)) {}

ToyPack::ToyPack(AlignedBytes bytes) : bytes_(std::move(bytes)) {
  auto opened = PackFile::view(bytes_.bytes(), "toys.pack");
  if (opened) {
    pack_.emplace(std::move(*opened));
  } else {
    ADD_FAILURE() << opened.error().text();
  }
}

}  // namespace galactic::test
