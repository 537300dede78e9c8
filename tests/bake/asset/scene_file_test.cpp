// A whole scene pack from a file: its grids and what is drawn.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "galactic/bake/assets.h"
#include "support/scratch_folder.h"
#include "support/test_meshes.h"

namespace galactic::test::scene_file_test {
namespace {

std::string objOf(const bake::TriangleMesh& mesh) {
  std::string text;
  for (const Vec3& p : mesh.vertices) text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
  for (const bake::Triangle& t : mesh.triangles) {
    text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
  return text;
}

TEST(SceneFile, ShowsANarrowClosedRoomFromInside) {
  const ScratchFolder scratch;
  for (const float width : {0.5F, 1.0F, 1.4F}) {
    bake::SceneJob job{
        .input = scratch.write("corridor.obj", objOf(MeshBuilder()
                                                         .box({0, 0, 0}, {width, 2.5F, 6})
                                                         .box({0.2F, 0.1F, 2}, {0.3F, 0.9F, 3})
                                                         .build()))};
    job.grids.check_columns = 0;
    bake::ReadLog log;
    bake::BakeLibraries libraries;
    bake::BakeContext context{
        .output = scratch.path() / "x.pack", .log = log, .libraries = libraries, .dry_run = true};
    const auto made = bake::bake(job, context);
    ASSERT_TRUE(made) << made.error().text();
    const auto& scene = std::get<bake::SceneOutcome>(made->outcome).scene;
    ASSERT_TRUE(scene.render_meshes);
    // The corridor, and not what stands in it.
    EXPECT_EQ(scene.render_meshes->statistics().two_sided_triangles, 12U) << "width " << width;
  }
}

}  // namespace
}  // namespace galactic::test::scene_file_test
