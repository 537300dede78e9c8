#include "dataset/mesh_library.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "bake/dataset/small_dataset.h"
#include "dataset/scene_dataset.h"

namespace galactic::test::mesh_library_test {
namespace {

using bake::MeshLibrary;

TEST(MeshLibrary, GivesTheSameMeshForAllSpellingsOfAPath) {
  const SmallDataset small;
  MeshLibrary meshes(bake::datasetMeshOptions());
  const auto first = meshes.load(small.folder() / "meshes/box.obj");
  const auto again = meshes.load(small.folder() / "urdf/../meshes/./box.obj");
  ASSERT_TRUE(first);
  ASSERT_TRUE(again);
  EXPECT_EQ(first->get(), again->get());
}

TEST(MeshLibrary, GivesUpOnlyWhatNobodyUsesWhenThereIsNoRoom) {
  const SmallDataset small;
  MeshLibrary meshes(bake::datasetMeshOptions(), 0);
  auto held = meshes.load(small.folder() / "meshes/box.obj");
  ASSERT_TRUE(held);
  const bake::SourceAsset* box = held->get();
  // Nobody holds this one: it is gone after the next load.
  ASSERT_TRUE(meshes.load(small.folder() / "meshes/room.obj"));
  small.write("meshes/room.obj", "no mesh any more");
  small.write("meshes/box.obj", "no mesh any more");
  ASSERT_TRUE(meshes.load(small.folder() / "bare/crate.glb"));
  EXPECT_EQ(meshes.load(small.folder() / "meshes/box.obj")->get(), box);
  EXPECT_FALSE(meshes.load(small.folder() / "meshes/room.obj"));
}

TEST(MeshLibrary, KeepsWhatNobodyUsesWhileThereIsRoom) {
  const SmallDataset small;
  MeshLibrary meshes(bake::datasetMeshOptions());
  ASSERT_TRUE(meshes.load(small.folder() / "meshes/room.obj"));
  ASSERT_TRUE(meshes.loadFurniture(small.folder() / "urdf/cupboard/cupboard.urdf"));
  small.write("meshes/room.obj", "no mesh any more");
  small.write("urdf/cupboard/cupboard.urdf", "no URDF any more");
  EXPECT_TRUE(meshes.load(small.folder() / "meshes/room.obj"));
  EXPECT_TRUE(meshes.loadFurniture(small.folder() / "urdf/cupboard/cupboard.urdf"));
}

TEST(MeshLibrary, FailsTheSameWayEachTime) {
  const SmallDataset small;
  MeshLibrary meshes(bake::datasetMeshOptions(), 0);
  const auto file = small.write("meshes/broken.glb", "no mesh");
  const auto first = meshes.load(file);
  small.write("meshes/broken.glb", glbFile(unevenBox()));
  const auto again = meshes.load(file);
  ASSERT_FALSE(first);
  ASSERT_FALSE(again);
  EXPECT_EQ(first.error().message, again.error().message);
}

TEST(MeshLibrary, ReadsAFileOnceForManyThreads) {
  constexpr unsigned kThreads = 8;
  constexpr unsigned kLoads = 6;
  const SmallDataset small;
  const std::vector<std::string> files{"meshes/box.obj", "meshes/room.obj", "bare/crate.glb"};
  MeshLibrary meshes(bake::datasetMeshOptions());
  std::vector<std::vector<std::shared_ptr<const bake::SourceAsset>>> loaded(kThreads);
  std::vector<std::thread> threads;
  for (unsigned n = 0; n < kThreads; ++n) {
    threads.emplace_back([&, n] {
      for (unsigned i = 0; i < kLoads; ++i) {
        auto mesh = meshes.load(small.folder() / files[(n + i) % files.size()]);
        if (mesh) loaded[n].push_back(std::move(*mesh));
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (unsigned n = 0; n < kThreads; ++n) {
    ASSERT_EQ(loaded[n].size(), kLoads);
    for (unsigned i = 0; i < kLoads; ++i) {
      const auto wanted = meshes.load(small.folder() / files[(n + i) % files.size()]);
      ASSERT_TRUE(wanted);
      EXPECT_EQ(loaded[n][i], *wanted);
    }
  }
}

TEST(MeshLibrary, StaysCorrectWhenThreadsAlwaysLackRoom) {
  constexpr unsigned kThreads = 4;
  constexpr unsigned kLoads = 8;
  const SmallDataset small;
  MeshLibrary meshes(bake::datasetMeshOptions(), 0);
  std::atomic<unsigned> right{0};
  std::vector<std::thread> threads;
  for (unsigned n = 0; n < kThreads; ++n) {
    threads.emplace_back([&, n] {
      for (unsigned i = 0; i < kLoads; ++i) {
        const bool box = (n + i) % 2 == 0;
        const auto mesh = meshes.load(small.folder() / (box ? "meshes/box.obj" : "bare/crate.glb"));
        if (mesh && (*mesh)->name == (box ? "box" : "crate")) ++right;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(right, kThreads * kLoads);
}

}  // namespace
}  // namespace galactic::test::mesh_library_test
