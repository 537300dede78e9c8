// A set of objects whose bake ends early goes on where it was, and ends as if nothing had happened.
#include "asset/object_journal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "galactic/bake/assets.h"
#include "support/build_paths.h"
#include "support/file_content.h"
#include "support/files/journal.h"
#include "support/mesh_files.h"
#include "support/program_run.h"
#include "support/scratch_folder.h"

namespace galactic::test::object_journal_test {
namespace {

namespace fs = std::filesystem;

using bake::BakedPack;
using bake::FinishedObject;
using bake::ObjectJournal;
using bake::ObjectSetOutcome;
using testing::ElementsAre;
using testing::SizeIs;

class AnObjectJournal : public testing::Test {
 protected:
  AnObjectJournal() {
    // One has a texture.
    for (const char* name : {"cereal_box", "plate"}) {
      const std::string file = std::string(name) + ".glb";
      write(file, fileContent(sourceFolder() / "packs/sample/objects" / file));
    }
    write("xylophone.obj", "v 0 0 0\n");
    job_.inputs = {folder_.path() / "things"};
    job_.shape.spheres.radii = {0.03F, 0.05F};
    job_.shape.spheres.eps = 0.02F;
    job_.shape.spheres.tau = 0.03F;
  }

  void write(const std::string& name, const std::string& content) const {
    (void)folder_.write("things/" + name, content);
  }
  /// Removes what breaks the set.
  void mend() const { write("xylophone.obj", objFile(smallBox())); }
  [[nodiscard]] static MeshContent smallBox() {
    MeshContent box = unevenBox();
    for (auto& position : box.positions) {
      for (float& value : position) value *= 0.03F;
    }
    return box;
  }

  [[nodiscard]] ObjectSetOutcome baked(const std::string& pack) const {
    bake::ReadLog log;
    bake::BakeLibraries libraries;
    bake::BakeContext context{.output = folder_.path() / pack, .log = log, .libraries = libraries};
    auto made = bakeObjectFiles(job_, context);
    EXPECT_TRUE(made) << made.error().text();
    return made ? std::get<ObjectSetOutcome>(std::move(made->outcome)) : ObjectSetOutcome{};
  }
  [[nodiscard]] fs::path file(const std::string& name) const { return folder_.path() / name; }
  [[nodiscard]] std::string content(const std::string& name) const {
    return fileContent(file(name));
  }

  ScratchFolder folder_;
  bake::ObjectJob job_;
};

/// What differs between any two bakes: how long reading took.
std::vector<double> timesOf(const ObjectSetOutcome& outcome) {
  std::vector<double> times;
  for (const ObjectSetOutcome::Origin& origin : outcome.origins) {
    times.push_back(origin.import_seconds);
  }
  return times;
}

TEST_F(AnObjectJournal, LetsASetGoOnWhereItEnded) {
  const ObjectSetOutcome broken = baked("out.pack");
  ASSERT_THAT(broken.failures, SizeIs(1));
  EXPECT_EQ(broken.failures[0].input.filename(), "xylophone.obj")
      << broken.failures[0].error.message;
  ASSERT_FALSE(fs::exists(file("out.pack")));
  const std::vector<double> before = timesOf(broken);
  ASSERT_THAT(before, SizeIs(2));
  mend();
  const std::vector<double> after = timesOf(baked("out.pack"));
  ASSERT_THAT(after, SizeIs(3));
  EXPECT_EQ(after[0], before[0]) << "was baked twice";
  EXPECT_EQ(after[1], before[1]) << "was baked twice";
  EXPECT_FALSE(fs::exists(file("out.pack.partial")));
  (void)baked("whole.pack");
  EXPECT_TRUE(content("out.pack") == content("whole.pack"));
}

TEST_F(AnObjectJournal, KeepsWhatIsDoneWhenASetIsToldToStop) {
  mend();
  // Asked before each object: the first is baked, the second is not begun.
  int questions = 0;
  bake::ReadLog log;
  bake::BakeLibraries libraries;
  bake::BakeContext context{
      .output = file("out.pack"), .log = log, .libraries = libraries, .stops = [&] {
        return questions++ > 0;
      }};
  const auto stopped = bakeObjectFiles(job_, context);
  ASSERT_FALSE(stopped.has_value());
  EXPECT_EQ(stopped.error().code, ErrorCode::kInterrupted);
  EXPECT_EQ(stopped.error().message, "interrupted after 1 of 3 objects");
  EXPECT_FALSE(fs::exists(file("out.pack")));
  EXPECT_THAT(content("out.pack.partial"), testing::HasSubstr("cereal_box"));
  (void)baked("out.pack");
  EXPECT_FALSE(fs::exists(file("out.pack.partial")));
  (void)baked("whole.pack");
  EXPECT_TRUE(content("out.pack") == content("whole.pack"));
  // What was asked after the last object has nothing to stop.
  questions = -3;
  EXPECT_TRUE(bakeObjectFiles(job_, context).has_value());
}

TEST_F(AnObjectJournal, ForgetsWhatIsOfOtherFilesOrOptions) {
  const std::vector<double> before = timesOf(baked("out.pack"));
  mend();
  const std::string kept = content("out.pack.partial");
  // The same name and size, and another mesh.
  const std::string plate = content("things/plate.glb");
  std::string other = plate;
  const std::size_t color = other.find("0.");
  ASSERT_NE(color, std::string::npos);
  other[color + 2] = other[color + 2] == '5' ? '6' : '5';
  write("plate.glb", other);
  const std::vector<double> after = timesOf(baked("out.pack"));
  EXPECT_EQ(after[0], before[0]);
  EXPECT_NE(after[1], before[1]) << "is of another file";
  (void)baked("whole.pack");
  EXPECT_TRUE(content("out.pack") == content("whole.pack"));

  write("plate.glb", plate);
  (void)folder_.write("out.pack.partial", kept);
  job_.shape.spheres.eps = 0.019F;
  const std::vector<double> finer = timesOf(baked("out.pack"));
  EXPECT_NE(finer[0], before[0]) << "is of other options";
  EXPECT_NE(finer[1], before[1]) << "is of other options";
}

TEST_F(AnObjectJournal, ForgetsWhatWasBakedWithoutAFileThatIsThereNow) {
  write("plate.obj", "mtllib plate.mtl\n" + objFile(smallBox()));
  fs::remove(file("things/plate.glb"));
  const std::vector<double> before = timesOf(baked("out.pack"));
  mend();
  write("plate.mtl", "newmtl red\nKd 1 0 0\n");
  const std::vector<double> after = timesOf(baked("out.pack"));
  EXPECT_EQ(after[0], before[0]);
  EXPECT_NE(after[1], before[1]);
}

/// Writes records of a bake, changed, and asks for them.
class AChangedRecord : public AnObjectJournal {
 protected:
  AChangedRecord() {
    mend();
    ObjectSetOutcome outcome = baked("whole.pack");
    finished_.object = std::move(outcome.objects.at(0));
  }

  [[nodiscard]] bool isTaken() const {
    const ObjectJournal written(open("written"), 2);
    EXPECT_TRUE(written.add(input_, finished_));
    const bool is_taken = ObjectJournal(open("written"), 2).recall(input_).has_value();
    fs::remove(file("written"));
    return is_taken;
  }

  [[nodiscard]] std::unique_ptr<Journal> open(const std::string& name) const {
    return Journal::open(file(name), "these").value();
  }

  const bake::ObjectInput input_{file("things/cereal_box.glb"), "cereal_box"};
  FinishedObject finished_;
};

TEST_F(AChangedRecord, IsTakenWhereAllThatItCountsIsThere) { EXPECT_TRUE(isTaken()); }

TEST_F(AChangedRecord, IsNotTakenWhereSomethingIsMissing) {
  const bake::BakedObject good = finished_.object;
  const auto refused = [&](auto&& change) {
    finished_.object = good;
    change(finished_.object, *finished_.object.render_meshes);
    return !isTaken();
  };
  using Object = bake::BakedObject;
  using Meshes = bake::BakedRenderMeshes;
  ASSERT_FALSE(good.render_meshes->materials.textures.empty());
  EXPECT_TRUE(refused([](Object& object, Meshes&) { object.name = "plate"; }));
  EXPECT_TRUE(
      refused([](Object& object, Meshes&) { object.spheres.spheres.at(0).radius_index = 2; }));
  EXPECT_TRUE(refused([](Object& object, Meshes&) { object.surface.positions.pop_back(); }));
  EXPECT_TRUE(refused([](Object& object, Meshes&) { object.surface.colors.push_back(0); }));
  EXPECT_TRUE(refused([](Object&, Meshes& meshes) { meshes.semantics.clear(); }));
  EXPECT_TRUE(refused([](Object&, Meshes& meshes) { meshes.materials.textures.clear(); }));
  EXPECT_TRUE(refused([](Object&, Meshes& meshes) { meshes.materials.texels.pop_back(); }));
  EXPECT_TRUE(refused([](Object&, Meshes& meshes) {
    meshes.materials.textures.at(0).size = std::uint32_t{1} << 31U;
  }));
  EXPECT_TRUE(refused([](Object&, Meshes& meshes) { meshes.materials.materials.clear(); }));
  EXPECT_TRUE(
      refused([](Object&, Meshes& meshes) { meshes.clusters.at(0).first_vertex = 0xFFFFFFFF; }));
}

}  // namespace
}  // namespace galactic::test::object_journal_test
