// Broken files of every format: an error or a sound mesh, never a crash, a hang or nonsense.
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "bake/import/import_helpers.h"

namespace galactic::test {
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
          {"a.glb", glbFile(mesh)},
          {"a.dae", daeFile(mesh, {"Z_UP", "0.01", ""})},
          {"a.fbx", fbxFile(mesh, {})}};
}

enum class Outcome { kAccepted, kRefused, kNonsense };

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
    return clean->mesh.triangles.empty() ? Outcome::kNonsense : Outcome::kAccepted;
  }

 private:
  std::string name_;
  ScratchFolder folder_;
};

class MalformedMesh : public testing::TestWithParam<Sample> {};

TEST_P(MalformedMesh, IsRefusedOrSoundAtEveryTruncation) {
  const auto& [name, content] = GetParam();
  const Trial trial(name);
  EXPECT_EQ(trial.run(content), Outcome::kAccepted) << "the sample itself is sound";
  std::size_t refused = 0;
  for (std::size_t size = 0; size < content.size(); ++size) {
    const Outcome outcome = trial.run(std::string_view(content).substr(0, size));
    EXPECT_NE(outcome, Outcome::kNonsense) << name << " cut to " << size << " bytes";
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

INSTANTIATE_TEST_SUITE_P(Formats, MalformedMesh, testing::ValuesIn(samples()),
                         [](const testing::TestParamInfo<Sample>& sample) {
                           std::string name = sample.param.name;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

}  // namespace
}  // namespace galactic::test
