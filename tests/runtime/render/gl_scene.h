#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "galactic/batch_renderer.h"
#include "support/packs/render_model_builder.h"
#include "support/render_images.h"

namespace galactic::test {

/// Options that ask for the OpenGL backend on any driver.
inline RenderOptions glOptions() {
  RenderOptions options;
  options.backend = RenderBackend::kGl;
  options.device = "software";
  return options;
}

/// Why the OpenGL backend cannot start here; empty when it can.
inline std::string glObstacle() {
  RenderLibrary library;
  const Result<BatchRenderer> made = BatchRenderer::create(library, glOptions());
  return made ? std::string() : made.error().message;
}

/// Skips a test where EGL or the software driver is not installed.
#define GALACTIC_SKIP_WITHOUT_GL() \
  if (const std::string why = galactic::test::glObstacle(); !why.empty()) GTEST_SKIP() << why

/// A camera at a place that looks along +X, turned left about Y, then up, degrees.
inline RenderCamera cameraAt(const Vec3& place, float yaw_degrees = 0, float pitch_degrees = 0,
                             float fov_degrees = 90) {
  const float yaw = radians(yaw_degrees) / 2;
  const float pitch = radians(pitch_degrees) / 2;
  const Quat turned =
      Quat{0, std::sin(yaw), 0, std::cos(yaw)} * Quat{0, 0, std::sin(pitch), std::cos(pitch)};
  return {rigidTransform({place, turned}), radians(fov_degrees)};
}

/// A wall across the X axis, 2 x `half` meters, seen from -X.
inline void addWall(RenderModelBuilder& builder, float x, float half,
                    const RenderSurface& surface = {}) {
  builder.quad({{{x, -half, -half}, {x, -half, half}, {x, half, half}, {x, half, -half}}}, surface);
}

/// A box with one side open at -X, of many small squares: `cells` along each edge of a side.
inline void addBox(RenderModelBuilder& builder, const Vec3& center, float half, int cells,
                   const RenderSurface& surface = {}) {
  const std::array<Vec3, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0F, 1.0F}) {
      const Vec3 out = axes[axis] * (half * side);
      // u x v points outwards.
      const Vec3 u = axes[(axis + 1) % 3] * (half * side);
      const Vec3 v = axes[(axis + 2) % 3] * half;
      for (int i = 0; i < cells * cells; ++i) {
        const auto at = [&](int a, int b) {
          const float s = 2 * static_cast<float>(a) / static_cast<float>(cells) - 1;
          const float t = 2 * static_cast<float>(b) / static_cast<float>(cells) - 1;
          return center + out + u * s + v * t;
        };
        const int a = i % cells;
        const int b = i / cells;
        builder.quad({{at(a, b), at(a + 1, b), at(a + 1, b + 1), at(a, b + 1)}}, surface);
      }
    }
  }
}

/// A home of many models: a floor, boxes of several materials, sheets and holes; and views of it.
class GlHome {
 public:
  explicit GlHome(std::uint32_t seed = 7) {
    std::mt19937 random(seed);
    builder_.keepColors();
    const std::int32_t checks = builder_.texture(64, checkerboard(64, 8, 0xFF2040F0, 0xFFE0C020));
    const std::int32_t holes = builder_.texture(32, checkerboard(32, 4, 0x00000000, 0xFF40A040));
    const std::int32_t rough = builder_.texture(128, noise(128, random));
    const std::array<std::uint16_t, 4> materials{
        builder_.material(0xFF3060A0), builder_.material(0xFFFFFFFF, checks),
        builder_.material(0xFFFFFFFF, holes, 0.5F), builder_.material(0xFFFFFFFF, rough)};
    for (std::uint16_t i = 0; i < kModels; ++i) {
      builder_.model();
      const RenderSurface surface{.material = materials[i % materials.size()],
                                  .semantic = builder_.semantic("thing"),
                                  .two_sided = i % 3 == 1};
      addBox(builder_, {0, 0, 0}, uniform(random, 0.1F, 0.6F), 2 + i % 7, surface);
      // A second material in the same model.
      addBox(builder_, {0.2F, 0.9F, 0}, 0.2F, 3,
             {materials[(i + 1U) % materials.size()], surface.semantic, i % 2 == 1});
    }
    builder_.model();
    addWall(builder_, 4, 8, {.material = materials[1]});
    builder_.finish();
    library_.add(builder_.meshes(), "home ");
  }

  [[nodiscard]] const RenderLibrary& library() const { return library_; }

  /// Random cameras among randomly placed models.
  [[nodiscard]] std::vector<RenderView> views(std::size_t count, std::uint32_t seed = 3) {
    std::mt19937 random(seed);
    instances_.emplace_back();
    std::vector<std::vector<RenderInstance>>& placed = instances_.back();
    placed.resize(count);
    std::vector<RenderView> views;
    for (std::vector<RenderInstance>& own : placed) {
      own.push_back({kModels, {}});
      for (int i = 0; i < 20; ++i) {
        const Vec3 place{uniform(random, -3, 3.5F), uniform(random, -1, 1), uniform(random, -3, 3)};
        own.push_back({static_cast<std::uint32_t>(random() % kModels),
                       rigidTransform({place, randomRotation(random)})});
      }
      const Vec3 eye{uniform(random, -4, 1), uniform(random, -0.5F, 0.5F), uniform(random, -2, 2)};
      views.push_back({cameraAt(eye, uniform(random, -60, 60), uniform(random, -30, 30),
                                uniform(random, 50, 100)),
                       own});
    }
    return views;
  }

  static std::vector<std::uint32_t> checkerboard(std::uint32_t size, std::uint32_t cells,
                                                 std::uint32_t first, std::uint32_t second) {
    std::vector<std::uint32_t> texels;
    texels.reserve(std::size_t{size} * size);
    for (std::uint32_t y = 0; y < size; ++y) {
      for (std::uint32_t x = 0; x < size; ++x) {
        texels.push_back((x * cells / size + y * cells / size) % 2 == 0 ? first : second);
      }
    }
    return texels;
  }

 private:
  static constexpr std::uint16_t kModels = 9;

  static std::vector<std::uint32_t> noise(std::uint32_t size, std::mt19937& random) {
    std::vector<std::uint32_t> texels(std::size_t{size} * size);
    for (std::uint32_t& texel : texels) {
      texel = 0xFF000000U | static_cast<std::uint32_t>(random() & 0xFFFFFFU);
    }
    return texels;
  }

  RenderModelBuilder builder_{1.0F / 1024};
  RenderLibrary library_;
  std::vector<std::vector<std::vector<RenderInstance>>> instances_;
};

}  // namespace galactic::test
