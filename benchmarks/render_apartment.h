#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "galactic/batch_renderer.h"
#include "support/render_images.h"
#include "support/render_model_builder.h"

namespace galactic::bench {

/// A furnished home made in code, for benchmarks of rendering where no world is at hand: a stage of
/// six rooms, thirty objects and a robot of twenty links, about 87,000 triangles in 51 instances, a
/// third of the objects seen from both sides.
class RenderApartment {
 public:
  RenderApartment() {
    std::mt19937 random(kSeed);
    for (std::size_t i = 0; i < kMaterials; ++i) {
      materials_.push_back(builder_.material(0xFFFFFFFF, builder_.texture(256, picture(random))));
    }
    addStage(random);
    for (std::uint16_t i = 0; i < kObjects + kLinks; ++i) {
      builder_.model();
      const bool is_link = i >= kObjects;
      const float radius = is_link ? 0.12F : test::uniform(random, 0.08F, 0.5F);
      const test::RenderSurface surface{.material = materials_[i % kMaterials],
                                        .two_sided = !is_link && i % 3 == 0};
      addBall({0, 0, 0}, radius, is_link ? 14 : 20, surface);
    }
    builder_.finish();
    library_.add(builder_.meshes());
  }

  [[nodiscard]] const RenderLibrary& library() const { return library_; }

  /// What the head cameras of so many envs see. Valid while this lives, until the next call.
  [[nodiscard]] std::vector<RenderView> views(std::size_t count) {
    std::mt19937 random(kSeed + 1);
    instances_.assign(count, {});
    std::vector<RenderView> views;
    views.reserve(count);
    for (std::vector<RenderInstance>& own : instances_) {
      own.push_back({0, {}});
      for (std::uint32_t i = 0; i < kObjects; ++i) {
        const Vec3 place{test::uniform(random, 0.3F, 11.7F), test::uniform(random, 0.1F, 1.2F),
                         test::uniform(random, 0.3F, 7.7F)};
        own.push_back({1 + i, rigidTransform({place, test::randomRotation(random)})});
      }
      const Vec3 eye{test::uniform(random, 0.5F, 11.5F), 1.2F, test::uniform(random, 0.5F, 7.5F)};
      const float half = test::uniform(random, 0, std::numbers::pi_v<float>);
      const Pose head{eye, Quat{0, std::sin(half), 0, std::cos(half)} *
                               Quat{0, 0, std::sin(-0.12F), std::cos(-0.12F)}};
      for (std::uint32_t i = 0; i < kLinks; ++i) {
        const float along = static_cast<float>(i) / static_cast<float>(kLinks);
        const Vec3 in_head{0.25F + 0.5F * along, -0.75F + 0.4F * along, 0.2F * along};
        own.push_back({1 + kObjects + i, rigidTransform({head * in_head, {}})});
      }
      views.push_back({{rigidTransform(head), test::radians(90)}, own});
    }
    return views;
  }

 private:
  static constexpr std::uint32_t kSeed = 20;
  static constexpr std::size_t kMaterials = 12;
  static constexpr std::uint16_t kObjects = 30;
  static constexpr std::uint16_t kLinks = 20;

  /// Soft blots, as pictures of rooms have them.
  static std::vector<std::uint32_t> picture(std::mt19937& random) {
    constexpr std::uint32_t kEdge = 256;
    std::array<float, 9> phases{};
    for (float& phase : phases) phase = test::uniform(random, 0, 6.28F);
    std::vector<std::uint32_t> texels;
    texels.reserve(std::size_t{kEdge} * kEdge);
    for (std::uint32_t y = 0; y < kEdge; ++y) {
      for (std::uint32_t x = 0; x < kEdge; ++x) {
        std::uint32_t texel = 0xFF000000;
        for (std::uint32_t c = 0; c < 3; ++c) {
          const float u = 6.2832F * static_cast<float>(x * (c + 2)) / kEdge;
          const float v = 6.2832F * static_cast<float>(y * (4 - c)) / kEdge;
          const float value = std::sin(u + phases[c]) * std::cos(v + phases[3 + c]) +
                              0.5F * std::sin(5 * u + 3 * v + phases[6 + c]);
          texel |= static_cast<std::uint32_t>(130 + 75 * value) << (8 * c);
        }
        texels.push_back(texel);
      }
    }
    return texels;
  }

  /// A rectangle of `cells` x `cells` quads; u x v is its outside.
  void addSheet(const Vec3& corner, const Vec3& u, const Vec3& v, int cells,
                const test::RenderSurface& surface) {
    const auto at = [&](int a, int b) {
      const float s = static_cast<float>(a) / static_cast<float>(cells);
      const float t = static_cast<float>(b) / static_cast<float>(cells);
      return test::RenderVertex{corner + u * s + v * t, 4 * s, 4 * t};
    };
    for (int b = 0; b < cells; ++b) {
      for (int a = 0; a < cells; ++a) {
        builder_.triangle({at(a, b), at(a + 1, b), at(a + 1, b + 1)}, surface);
        builder_.triangle({at(a, b), at(a + 1, b + 1), at(a, b + 1)}, surface);
      }
    }
  }

  /// 4 * rings * rings triangles.
  void addBall(const Vec3& centre, float radius, int rings, const test::RenderSurface& surface) {
    const auto at = [&](int ring, int turn) {
      const float a =
          std::numbers::pi_v<float> * static_cast<float>(ring) / static_cast<float>(rings);
      const float b =
          std::numbers::pi_v<float> * static_cast<float>(turn) / static_cast<float>(rings);
      const Vec3 out{std::sin(a) * std::cos(b), std::cos(a), -std::sin(a) * std::sin(b)};
      return test::RenderVertex{centre + out * radius, b / 3, a / 3};
    };
    for (int ring = 0; ring < rings; ++ring) {
      for (int turn = 0; turn < 2 * rings; ++turn) {
        builder_.triangle({at(ring, turn), at(ring + 1, turn), at(ring + 1, turn + 1)}, surface);
        builder_.triangle({at(ring, turn), at(ring + 1, turn + 1), at(ring, turn + 1)}, surface);
      }
    }
  }

  /// Six rooms of 4 x 4 m with floors, ceilings, walls with doors left out, and fixed furniture.
  void addStage(std::mt19937& random) {
    builder_.model();
    for (int room = 0; room < 6; ++room) {
      const float x = 4.0F * static_cast<float>(room % 3);
      const int row = room / 3;
      const float z = 4.0F * static_cast<float>(row);
      const test::RenderSurface surface{
          .material = materials_[static_cast<std::size_t>(room) % kMaterials]};
      addSheet({x, 0, z + 4}, {4, 0, 0}, {0, 0, -4}, 16, surface);
      addSheet({x, 2.5F, z}, {4, 0, 0}, {0, 0, 4}, 16, surface);
      const test::RenderSurface wall{.material = surface.material, .two_sided = true};
      addSheet({x, 0, z}, {2.8F, 0, 0}, {0, 2.5F, 0}, 12, wall);
      addSheet({x, 0, z}, {0, 0, 2.8F}, {0, 2.5F, 0}, 12, wall);
      for (int i = 0; i < 6; ++i) {
        const Vec3 centre{x + test::uniform(random, 0.4F, 3.6F), test::uniform(random, 0.2F, 1.5F),
                          z + test::uniform(random, 0.4F, 3.6F)};
        addBall(centre, test::uniform(random, 0.1F, 0.4F), 9, surface);
      }
    }
    addSheet({12, 0, 0}, {0, 0, 8}, {0, 2.5F, 0}, 24,
             {.material = materials_[0], .two_sided = true});
    addSheet({0, 0, 8}, {12, 0, 0}, {0, 2.5F, 0}, 24,
             {.material = materials_[1], .two_sided = true});
  }

  test::RenderModelBuilder builder_{1.0F / 2048};
  std::vector<std::uint16_t> materials_;
  RenderLibrary library_;
  std::vector<std::vector<RenderInstance>> instances_;
};

}  // namespace galactic::bench
