// Both backends draw the same images.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <random>

#include "runtime/render/gl_scene.h"

namespace galactic::test::gl_agreement_test {
namespace {

/// Pixels at the edge of two surfaces may fall to either: drivers round positions differently.
constexpr double kMeanColor = 0.2;
constexpr float kDepth = 0.01F;
constexpr double kDeepShare = 0.0005;

TEST(BackendAgreement, ImagesOfTheOpenGlDriverAndOfTheRasterizerDifferLessThanCanBeSeen) {
  GALACTIC_SKIP_WITHOUT_GL();
  GlHome home;
  const std::vector<RenderView> views = home.views(48);
  RenderOptions options = glOptions();
  options.semantics = true;
  const RenderImages gl = renderViews(home.library(), options, views);
  options.backend = RenderBackend::kSoft;
  const RenderImages soft = renderViews(home.library(), options, views);
  double color = 0;
  std::size_t far = 0;
  std::size_t drawn = 0;
  std::size_t other = 0;
  const std::size_t pixels = gl.depth.size();
  for (std::size_t i = 0; i < gl.color.size(); ++i) {
    // Alpha tells only whether something is drawn.
    if (i % 4 != 3) color += std::abs(gl.color[i] - soft.color[i]);
  }
  for (std::size_t i = 0; i < pixels; ++i) {
    const bool apart = !(std::abs(gl.depth[i] - soft.depth[i]) <= kDepth);
    far += apart ? 1U : 0U;
    drawn += gl.depth[i] > 0 ? 1U : 0U;
    other += gl.semantics[i] != soft.semantics[i] ? 1U : 0U;
  }
  const double mean = color / (3.0 * static_cast<double>(pixels));
  const auto share = [&](std::size_t count) {
    return static_cast<double>(count) / static_cast<double>(pixels);
  };
  std::printf("mean color difference %.4f of 255, depth off on %.5f %%, another id on %.5f %%\n",
              mean, 100 * share(far), 100 * share(other));
  EXPECT_LT(mean, kMeanColor);
  EXPECT_LT(share(far), kDeepShare);
  EXPECT_LT(share(other), kDeepShare);
  // Both sides of the question occur: surfaces, and background.
  EXPECT_GT(share(drawn), 0.1);
  EXPECT_LT(share(drawn), 0.9);
}

TEST(BackendAgreement, TheSameNoiseIsAddedToTheImagesOfBoth) {
  GALACTIC_SKIP_WITHOUT_GL();
  GlHome home;
  std::vector<RenderView> views = home.views(6);
  for (std::size_t n = 0; n < views.size(); ++n) {
    views[n].noise.moment.env = static_cast<std::uint32_t>(n);
  }
  RenderOptions options = glOptions();
  options.noise = {.depth_noise = 0.01F, .depth_dropout = 0.2F, .color_noise = 8};
  const RenderImages gl = renderViews(home.library(), options, views);
  RenderOptions plain = options;
  plain.noise = {};
  const RenderImages gl_plain = renderViews(home.library(), plain, views);
  plain.backend = RenderBackend::kSoft;
  options.backend = RenderBackend::kSoft;
  const RenderImages soft = renderViews(home.library(), options, views);
  const RenderImages soft_plain = renderViews(home.library(), plain, views);
  std::size_t compared = 0;
  std::size_t dropped = 0;
  for (std::size_t i = 0; i < gl.depth.size(); ++i) {
    if (gl_plain.depth[i] == 0 || soft_plain.depth[i] == 0) continue;
    ++compared;
    dropped += gl.depth[i] == 0 ? 1U : 0U;
    ASSERT_EQ(gl.depth[i] == 0, soft.depth[i] == 0);
    if (gl.depth[i] == 0 || std::abs(gl_plain.depth[i] - soft_plain.depth[i]) > 1e-3F) continue;
    // A millimeter of depth changes noise by little, too.
    ASSERT_NEAR(gl.depth[i], soft.depth[i], 2e-3F);
  }
  EXPECT_GT(dropped, compared / 10);
  EXPECT_LT(dropped, compared / 3);
  for (std::size_t i = 0; i < gl.color.size(); ++i) {
    if (gl_plain.color[i] == soft_plain.color[i]) {
      ASSERT_EQ(gl.color[i], soft.color[i]);
    }
  }
}

TEST(BackendAgreement, WhereAModelIsInOnePlaceTwiceTheFirstShows) {
  GALACTIC_SKIP_WITHOUT_GL();
  constexpr std::uint32_t kSeed = 5;
  RecordProperty("seed", static_cast<int>(kSeed));
  constexpr std::size_t kEach = 10;
  constexpr std::uint32_t kFirst = 1000;
  constexpr std::uint32_t kSecond = 2000;
  GlHome home;
  std::mt19937 random(kSeed);
  // Models of each view: instances, posed models, and then all of them again, under other ids.
  std::vector<RenderView> once = home.views(6);
  std::vector<std::vector<RenderInstance>> instances(once.size());
  std::vector<std::vector<PosedModel>> posed(once.size());
  std::vector<std::uint32_t> ids(kEach, kFirst);
  ids.insert(ids.end(), 2 * kEach, kSecond);
  std::vector<RenderView> twice = once;
  for (std::size_t v = 0; v < once.size(); ++v) {
    for (std::size_t n = 0; n < 2 * kEach; ++n) {
      const Vec3 place{uniform(random, -3, 3.5F), uniform(random, -1, 1), uniform(random, -3, 3)};
      posed[v].push_back({static_cast<std::uint32_t>(n % 9), {place, randomRotation(random)}});
    }
    for (std::size_t n = kEach; n < 2 * kEach; ++n) {
      instances[v].push_back({posed[v][n].model, rigidTransform(posed[v][n].world_from_model)});
    }
    const std::vector<PosedModel> again = posed[v];
    posed[v].resize(kEach);
    posed[v].insert(posed[v].end(), again.begin(), again.end());
    once[v].instances = twice[v].instances = instances[v];
    once[v].posed = {posed[v].data(), kEach};
    once[v].posed_semantics = {ids.data(), kEach};
    twice[v].posed = posed[v];
    twice[v].posed_semantics = ids;
  }
  RenderOptions options = glOptions();
  options.semantics = true;
  for (const RenderBackend backend : {RenderBackend::kGl, RenderBackend::kSoft}) {
    options.backend = backend;
    const RenderImages wanted = renderViews(home.library(), options, once);
    EXPECT_EQ(renderViews(home.library(), options, twice), wanted) << backendName(backend);
    const auto share = static_cast<double>(std::ranges::count(wanted.semantics, kFirst)) /
                       static_cast<double>(wanted.semantics.size());
    EXPECT_GT(share, 0.1);
    EXPECT_LT(share, 0.9);
  }
}

}  // namespace
}  // namespace galactic::test::gl_agreement_test
