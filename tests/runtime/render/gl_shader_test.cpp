// Every shader that a renderer can be made of, judged by the reference compiler of the language: a
// driver of one vendor accepts what another one refuses.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "render/gl/shader_sources.h"

namespace galactic::render::gl::gl_shader_test {
namespace {

std::vector<ShaderVariant> allVariants() {
  std::vector<ShaderVariant> variants;
  for (const bool layer_in_vertex : {false, true}) {
    for (const bool vertex_colors : {false, true}) {
      for (const unsigned color_bytes : {0U, 3U, 4U}) {
        for (const bool depth : {false, true}) {
          for (const bool semantics : {false, true}) {
            for (const std::size_t arrays : {std::size_t{0}, std::size_t{3}}) {
              variants.push_back({layer_in_vertex, vertex_colors, color_bytes != 0, color_bytes,
                                  depth, semantics, arrays});
            }
          }
        }
      }
    }
  }
  return variants;
}

/// Shaders in a folder of their own, each in a file whose ending tells the stage.
class ShaderFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::system("glslangValidator --version >/dev/null 2>&1") != 0) {
      GTEST_SKIP() << "no glslangValidator (Debian: glslang-tools)";
    }
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void add(const std::string& source, const std::string& stage) {
    std::ofstream(folder_ / (std::to_string(count_++) + "." + stage)) << source;
  }
  /// What the compiler says of all of them; empty when it accepts them.
  [[nodiscard]] std::string judge() const {
    const std::filesystem::path said = folder_ / "said.txt";
    const std::string command = "cd " + folder_.string() +
                                " && glslangValidator --quiet $(ls | grep -v said.txt) > said.txt";
    const int code = std::system(command.c_str());
    std::ifstream file(said);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    return code == 0 ? std::string() : "glslangValidator: " + text;
  }
  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  std::filesystem::path folder_ = std::filesystem::path(::testing::TempDir()) /
                                  ("galactic_shader_files_" + std::to_string(::getpid()));
  std::size_t count_ = 0;
};

TEST_F(ShaderFiles, OfEveryVariantAreAccepted) {
  for (const ShaderVariant& variant : allVariants()) {
    add(vertexSource(variant), "vert");
    if (!variant.layer_in_vertex) add(geometrySource(variant), "geom");
    for (const bool masked : {false, true}) add(fragmentSource(variant, masked), "frag");
    add(resolveSource(variant), "comp");
  }
  for (const std::string& source : {testSource(), scanSource(), emitSource()}) add(source, "comp");
  EXPECT_EQ(judge(), "");
  EXPECT_GT(count(), 400U);
}

TEST_F(ShaderFiles, WithAMistakeAreRefused) {
  std::string source = scanSource();
  source.replace(source.find("bitCount"), 8, "bitSum__");
  add(source, "comp");
  EXPECT_NE(judge().find("bitSum__"), std::string::npos);
}

}  // namespace
}  // namespace galactic::render::gl::gl_shader_test

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
// The search for leaks fails itself while threads of the OpenGL driver end; the rest of the
// sanitizer stays on.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() { return "detect_leaks=0"; }
#endif
#endif
