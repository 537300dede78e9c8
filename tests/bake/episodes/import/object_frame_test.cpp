#include "episodes/import/object_frame.h"

#include <gtest/gtest.h>

#include "galactic/bake/mesh_import.h"
#include "galactic/bake/triangle_mesh.h"
#include "support/scratch_folder.h"

namespace galactic::test::object_frame_test {
namespace {

using bake::UpAxis;

/// Points of about a meter in float.
constexpr float kRounding = 1e-6F;

TEST(ObjectFrames, UndoWhatTheMeshImporterDoes) {
  const ScratchFolder folder;
  const auto file = folder.write("t.obj", "v 0.5 1 2\nv 3 -1 0.25\nv -2 4 1\nf 1 2 3\n");
  const std::vector<Vec3> in_file{{0.5F, 1, 2}, {3, -1, 0.25F}, {-2, 4, 1}};
  for (const UpAxis up :
       {UpAxis::kX, UpAxis::kY, UpAxis::kZ, UpAxis::kMinusX, UpAxis::kMinusY, UpAxis::kMinusZ}) {
    SCOPED_TRACE(static_cast<int>(up));
    bake::MeshImportOptions options;
    options.up = up;
    const auto asset = bake::importMesh(file, options);
    ASSERT_TRUE(asset.has_value()) << asset.error().message;
    const auto cleaned = bake::placeAndClean(*asset);
    ASSERT_TRUE(cleaned.has_value());
    ASSERT_EQ(cleaned->mesh.vertices.size(), in_file.size());
    const Quat file_from_pack = bake::narrow(bake::fileFromPack(up));
    for (std::size_t n = 0; n < in_file.size(); ++n) {
      const Vec3 back = rotate(file_from_pack, cleaned->mesh.vertices[n]);
      EXPECT_NEAR(back.x, in_file[n].x, kRounding);
      EXPECT_NEAR(back.y, in_file[n].y, kRounding);
      EXPECT_NEAR(back.z, in_file[n].z, kRounding);
    }
  }
}

TEST(ObjectFrames, MultiplyAsQuaternionsDo) {
  const Quat a{0.5F, -0.5F, 0.5F, 0.5F};
  const Quat b{0, 0.6F, 0, 0.8F};
  const bake::Rotation product = bake::product({0.5, 0.5, -0.5, 0.5}, {0.8, 0, 0.6, 0});
  const Quat wanted = a * b;
  const Quat found = bake::narrow(product);
  EXPECT_NEAR(found.x, wanted.x, kRounding);
  EXPECT_NEAR(found.y, wanted.y, kRounding);
  EXPECT_NEAR(found.z, wanted.z, kRounding);
  EXPECT_NEAR(found.w, wanted.w, kRounding);
}

}  // namespace
}  // namespace galactic::test::object_frame_test
