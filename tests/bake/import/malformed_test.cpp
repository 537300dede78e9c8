// Broken files of every format: an error or a sound mesh, never a crash, a hang or nonsense.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "bake/import/import_helpers.h"

namespace galactic::test::malformed_test {
namespace {

using bake::importMesh;
using bake::MeshImportOptions;
using bake::placeAndClean;

struct Sample {
  const char* name;
  std::string content;
};

std::ostream& operator<<(std::ostream& out, const Sample& sample) { return out << sample.name; }

/// A tetrahedron: small enough to try every truncation.
MeshContent tetrahedron() {
  return {.positions = {{0, 0, 0}, {1.5F, 0, 0}, {0, 2.5F, 0}, {0, 0, 3.5F}},
          .triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

std::vector<Sample> samples() {
  const MeshContent mesh = tetrahedron();
  return {{"a.obj", objFile(mesh)},
          {"ascii.ply", plyAsciiFile(mesh)},
          {"binary.ply", plyBinaryFile(mesh)},
          {"ascii.stl", stlAsciiFile(mesh)},
          {"binary.stl", stlBinaryFile(mesh)},
          {"a.off", offFile(mesh)},
          {"a.glb", glbFile(mesh)},
          {"a.dae", daeFile(mesh, {"Z_UP", "0.01", ""})},
          {"a.fbx", fbxFile(mesh, {})}};
}

/// Partial: something is missing, and nobody said so.
enum class Outcome { kAccepted, kPartial, kRefused, kNonsense };

/// Imports the bytes, and looks at what comes out.
class Trial {
 public:
  explicit Trial(std::string name) : name_(std::move(name)) {}

  [[nodiscard]] Outcome run(std::string_view content) const {
    MeshImportOptions options;
    options.time_limit = std::chrono::seconds(20);
    options.memory_limit = std::uint64_t{1} << 30U;
    const auto asset = importMesh(folder_.write(name_, content), options);
    if (!asset) {
      const Error& error = asset.error();
      const bool explained = !error.where.empty() && !error.message.empty();
      if (error.code == ErrorCode::kInternal || !explained) return Outcome::kNonsense;
      return Outcome::kRefused;
    }
    const auto clean = placeAndClean(*asset);
    if (!clean) {
      return clean.error().code == ErrorCode::kInvalidInput ? Outcome::kRefused
                                                            : Outcome::kNonsense;
    }
    for (const bake::Triangle& triangle : clean->mesh.triangles) {
      for (const std::uint32_t vertex : triangle) {
        if (vertex >= clean->mesh.vertices.size()) return Outcome::kNonsense;
        const Vec3& v = clean->mesh.vertices[vertex];
        const float far = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
        if (!(far <= static_cast<float>(bake::kMaxCoordinate))) return Outcome::kNonsense;
      }
    }
    const std::size_t whole = tetrahedron().triangles.size();
    if (clean->mesh.triangles.size() < whole) return Outcome::kPartial;
    return clean->mesh.triangles.size() > whole ? Outcome::kNonsense : Outcome::kAccepted;
  }

 private:
  std::string name_;
  ScratchFolder folder_;
};

class MalformedMesh : public testing::TestWithParam<Sample> {};

/// Whether the file states nothing that tells this truncation from a whole file: faces of an OBJ
/// are not counted, and its last line needs no end.
bool mayBeWhole(std::string_view name, std::string_view content, std::size_t size) {
  return name.ends_with(".obj") && (content[size] == '\n' || content[size - 1] == '\n');
}

TEST_P(MalformedMesh, IsRefusedOrWholeAtEveryTruncation) {
  const auto& [name, content] = GetParam();
  const Trial trial(name);
  EXPECT_EQ(trial.run(content), Outcome::kAccepted) << "the sample itself is sound";
  std::size_t refused = 0;
  for (std::size_t size = 0; size < content.size(); ++size) {
    const Outcome outcome = trial.run(std::string_view(content).substr(0, size));
    EXPECT_NE(outcome, Outcome::kNonsense) << name << " cut to " << size << " bytes";
    if (outcome == Outcome::kPartial) {
      EXPECT_TRUE(mayBeWhole(name, content, size)) << name << " cut to " << size << " bytes";
    }
    refused += outcome == Outcome::kRefused ? 1 : 0;
  }
  EXPECT_GE(refused, content.size() / 10);
}

TEST_P(MalformedMesh, IsRefusedOrSoundAfterRandomChanges) {
  constexpr unsigned kSeed = 31;
  constexpr int kTrials = 400;
  const auto& [name, content] = GetParam();
  SCOPED_TRACE(fmt::format("seed {}", kSeed));
  std::mt19937 random(kSeed);
  const Trial trial(name);
  int refused = 0;
  for (int n = 0; n < kTrials; ++n) {
    std::string changed = content;
    // Half of the trials flip the lowest bit of one byte, which text formats often take for other
    // numbers; the others replace up to eight bytes by anything.
    if (n % 2 == 0) {
      char& byte = changed[random() % changed.size()];
      byte = static_cast<char>(byte ^ 1);
    } else {
      for (auto changes = 1 + random() % 8; changes > 0; --changes) {
        changed[random() % changed.size()] = static_cast<char>(random() % 256);
      }
    }
    const Outcome outcome = trial.run(changed);
    EXPECT_NE(outcome, Outcome::kNonsense) << name << ", change " << n;
    refused += outcome == Outcome::kRefused ? 1 : 0;
  }
  RecordProperty("refused", refused);
  EXPECT_GE(refused, kTrials / 10);
  EXPECT_LE(refused, kTrials * 9 / 10);
}

/// Checks go by the name of a file, and so do readers.
TEST_P(MalformedMesh, IsRefusedUnderTheNameOfAnotherFormat) {
  const auto& [name, content] = GetParam();
  const auto extension = std::filesystem::path(name).extension();
  for (const char* other : {".obj", ".ply", ".stl", ".off", ".glb", ".gltf", ".dae", ".fbx"}) {
    if (other == extension) continue;
    const Trial trial("a" + std::string(other));
    EXPECT_EQ(trial.run(content), Outcome::kRefused) << name << " as " << other;
  }
}

/// The text with the first number behind `before` changed by `difference`.
std::string withCount(std::string text, std::string_view before, int difference) {
  const std::size_t begin = text.find(before) + before.size();
  std::size_t length = 0;
  const int count = std::stoi(text.substr(begin), &length);
  return text.replace(begin, length, std::to_string(count + difference));
}

std::string withWord(std::string bytes, std::size_t at, std::uint32_t word) {
  return bytes.replace(at, sizeof(word), bytesOf(word));
}

TEST(StatedCounts, AreWhatIsThere) {
  const MeshContent mesh = tetrahedron();
  const auto expect_refused = [](const std::string& name, const std::string& content,
                                 const std::string& message) {
    const Error error = importError(name, content);
    EXPECT_EQ(error.code, ErrorCode::kInvalidInput) << name;
    EXPECT_THAT(error.message, testing::HasSubstr(message)) << name;
    EXPECT_THAT(error.where, testing::HasSubstr(name));
  };
  const std::string ascii = plyAsciiFile(mesh);
  const std::string binary = plyBinaryFile(mesh);
  expect_refused("a.ply", withCount(ascii, "element face ", 1),
                 "its PLY header states 5 of element face, and the file ends after 4; the file is "
                 "cut off or damaged");
  expect_refused("a.ply", withCount(ascii, "element face ", -1),
                 "it goes on behind the 3 of element face that its PLY header states");
  expect_refused("a.ply", withCount(ascii, "element vertex ", 1),
                 "its PLY header states 4 of element face, and the file ends after 3");
  expect_refused("a.ply",
                 withCount(ascii, "end_header\n", 1).replace(ascii.size() - 8, 8, "3 1 2\n"),
                 "face 3 ends early in \"3 1 2\"");
  expect_refused("b.ply", withCount(binary, "element face ", 1),
                 "states 5 of element face, and the file ends after 4");
  expect_refused("b.ply", withCount(binary, "element face ", -1), "it goes on behind the 3");
  expect_refused("b.ply", withCount(binary, "element vertex ", 1000),
                 "states 1004 of element vertex");
  const std::string off = offFile(mesh);
  expect_refused("a.off", withCount(off, "OFF\n4 ", 1), "it states 5 faces, and has 4 whole ones");
  expect_refused("a.off", withCount(off, "OFF\n4 ", -1), "it goes on behind the 3 faces");
  expect_refused("a.off", withCount(off, "OFF\n", 9), "it states 13 vertices, and has ");
  const std::string stl = stlBinaryFile(mesh);
  constexpr std::size_t kStlCount = 80;
  expect_refused("a.stl", withWord(stl, kStlCount, 5),
                 "it states 5 triangles, and its 284 bytes hold 4");
  expect_refused("a.stl", withWord(stl, kStlCount, 3),
                 "it states 3 triangles, and its 284 bytes hold 4");
  expect_refused("b.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendsolid\n",
                 "it has 1 facets, 0 of which are closed, and 1 vertices");
  expect_refused("a.obj", objFile(mesh) + "f 1 2 5\n", "line 9 uses vertex 5, and it has 4");
  expect_refused("a.obj", objFile(mesh) + "v 1 .5 0\nf -1 -2 -3\n",
                 "line 9 has the number '.5', which the reader of .obj files does not take; write "
                 "it as '0.5'");
  expect_refused("a.obj", objFile(mesh) + "f 1/1 2/2 3", "it ends inside line 9");
  expect_refused("a.obj", objFile(mesh) + "v 1 2", "it ends inside line 9");
  expect_refused("a.obj", objFile(mesh) + "usemtl re", "it ends inside line 9");
}

std::string repeated(const std::string& line, std::size_t times) {
  std::string lines;
  lines.reserve(times * line.size());
  for (std::size_t n = 0; n < times; ++n) lines += line;
  return lines;
}

TEST(SlowInputs, AreRefusedByTheirCounts) {
  const MeshContent mesh = tetrahedron();
  const auto expect_refused = [](const std::string& name, const std::string& content,
                                 const std::string& message) {
    const Error error = importError(name, content);
    EXPECT_EQ(error.code, ErrorCode::kInvalidInput) << name;
    EXPECT_THAT(error.message, testing::HasSubstr(message)) << name;
  };
  const std::string comment = "comment nothing to say\n";
  std::string ply = plyAsciiFile(mesh);
  const std::size_t element = ply.find("element vertex ");
  const ScratchFolder folder;
  EXPECT_TRUE(importMesh(
      folder.write("a.ply", std::string(ply).insert(element, repeated(comment, 900))), {}));
  expect_refused("a.ply", ply.insert(element, repeated(comment, 500'000)),
                 "its PLY header has more than 10000 lines, at most so many are read; remove its "
                 "comments");
  const std::string obj = objFile(mesh);
  EXPECT_TRUE(importMesh(folder.write("a.obj", repeated("mtllib none.mtl\n", 900) + obj), {}));
  expect_refused("a.obj", repeated("mtllib none.mtl\n", 100'000) + obj,
                 "it names more than 1000 material files, at most so many are read; export it with "
                 "one");
  std::string circle;
  std::string face = "f";
  for (int n = 1; n <= 25'000; ++n) {
    const double angle = 2 * std::numbers::pi * n / 25'000;
    circle += fmt::format("v {:.6f} {:.6f} 0\n", std::cos(angle), std::sin(angle));
    face += fmt::format(" {}", n);
  }
  expect_refused("circle.obj", circle + face + "\n",
                 "has a polygon of 25000 corners, and the file's polygons take more than "
                 "200000000 comparisons to be cut into triangles; export triangles");
}

TEST(StatedCounts, OfGltfAreWhatIsThere) {
  const MeshContent mesh = tetrahedron();
  GltfPieces pieces;
  pieces.buffer_uri = R"("uri":"a.bin",)";
  const std::string json = gltfFile(mesh, pieces);
  const std::string buffer = gltfBuffer(mesh);
  const ScratchFolder folder;
  const auto import = [&](const std::string& document, const std::string& bytes) {
    (void)folder.write("a.bin", bytes);
    return importMesh(folder.write("a.gltf", document), {});
  };
  ASSERT_TRUE(import(json, buffer).has_value());
  for (std::size_t size = 0; size < buffer.size(); ++size) {
    const auto cut = import(json, buffer.substr(0, size));
    ASSERT_FALSE(cut.has_value()) << size;
    EXPECT_THAT(cut.error().message,
                testing::HasSubstr(fmt::format("buffer 0 states 96 bytes and has {}", size)));
  }
  const auto pointer = import(json, "version https://git-lfs.github.com/spec/v1\n");
  ASSERT_FALSE(pointer.has_value());
  EXPECT_EQ(pointer.error().message,
            "its buffer 'a.bin' is a pointer of Git LFS (fetch it with git lfs pull)");
  struct Fault {
    std::string before;
    int difference;
    std::string message;
  };
  // Where each count of the file stands, from the left.
  for (const Fault& fault : std::vector<Fault>{
           {R"("componentType":5125,"count":)", 3,
            "accessor 0 states 15 elements, and its buffer view holds 12"},
           {R"("componentType":5126,"count":)", 1,
            "accessor 1 states 5 elements, and its buffer view holds 4"},
           {R"("componentType":5125,"count":)", -1, "has 11 corners of triangles"},
           {R"("bufferViews":[{"buffer":0,"byteLength":)", 100,
            "buffer view 0 is 148 bytes from 0 on, and its buffer has 96"},
           {R"("byteOffset":)", 4, "buffer view 1 is 48 bytes from 52 on"},
           {R"("uri":"a.bin","byteLength":)", 4, "buffer 0 states 100 bytes and has 96"}}) {
    const auto wrong = import(withCount(json, fault.before, fault.difference), buffer);
    ASSERT_FALSE(wrong.has_value()) << fault.message;
    EXPECT_THAT(wrong.error().message, testing::HasSubstr(fault.message));
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, MalformedMesh, testing::ValuesIn(samples()),
                         [](const testing::TestParamInfo<Sample>& sample) {
                           std::string name = sample.param.name;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

}  // namespace
}  // namespace galactic::test::malformed_test
