#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "galactic/batch_renderer.h"
#include "support/render_images.h"

namespace galactic::test {

/// The same models twice, for each of some cameras: all as instances, and a part of them as posed
/// models and on bodies. Two robots take turns, so that their lists follow themselves and others.
class MixedModels {
 public:
  static constexpr std::size_t kOfEach = 5;
  static constexpr std::size_t kBodies = 3;

  /// `views` give the cameras.
  MixedModels(std::mt19937& random, std::uint32_t models, std::span<const RenderView> views)
      : lists_(views.size()) {
    const auto model = [&] { return static_cast<std::uint32_t>(random() % models); };
    const auto pose = [&](float reach) {
      const auto place = [&] { return uniform(random, -reach, reach); };
      return Pose{{place(), place(), place()}, randomRotation(random)};
    };
    for (std::vector<AttachedModel>& robot : robots_) {
      for (std::size_t n = 0; n < kOfEach; ++n) {
        robot.push_back(
            {model(), static_cast<std::uint32_t>(random() % kBodies), rigidTransform(pose(0.5F))});
      }
    }
    for (std::size_t v = 0; v < views.size(); ++v) {
      Lists& lists = lists_[v];
      RenderView mixed{.camera = views[v].camera};
      if (v % 5 != 1) {
        for (std::size_t n = 0; n < kOfEach; ++n) {
          lists.instances.push_back({model(), rigidTransform(pose(2.5F))});
        }
      }
      if (v % 5 != 2) {
        for (std::size_t n = 0; n < kOfEach; ++n) lists.posed.push_back({model(), pose(2.5F)});
      }
      mixed.instances = lists.instances;
      mixed.posed = lists.posed;
      if (v % 5 != 3) {
        for (std::size_t n = 0; n < kBodies; ++n) {
          lists.bodies.push_back(rigidTransform(pose(2.5F)));
        }
        mixed.attached = robots_[v / 2 % 2];
        mixed.bodies = lists.bodies;
      }
      lists.all = lists.instances;
      for (const PosedModel& posed : mixed.posed) {
        lists.all.push_back({posed.model, rigidTransform(posed.world_from_model)});
      }
      for (const AttachedModel& attached : mixed.attached) {
        lists.all.push_back(
            {attached.model, lists.bodies[attached.body] * attached.body_from_model});
      }
      mixed_.push_back(mixed);
      for (std::size_t n = 0; n < lists.posed.size(); ++n) lists.numbers.push_back(number(n));
      numbered_.push_back(mixed);
      numbered_.back().posed_semantics = lists.numbers;
      as_instances_.push_back({.camera = views[v].camera, .instances = lists.all});
    }
  }

  [[nodiscard]] const std::vector<RenderView>& mixed() const { return mixed_; }
  [[nodiscard]] const std::vector<RenderView>& asInstances() const { return as_instances_; }

  /// mixed(), where the posed model n of a view has the semantic id number(n).
  [[nodiscard]] const std::vector<RenderView>& numbered() const { return numbered_; }
  static std::uint32_t number(std::size_t n) { return 1000 + static_cast<std::uint32_t>(n); }

  /// The posed model n of each view, and nothing else.
  [[nodiscard]] std::vector<RenderView> posedAlone(std::size_t n) const {
    std::vector<RenderView> alone;
    for (const RenderView& view : mixed_) {
      alone.push_back({.camera = view.camera});
      if (n < view.posed.size()) alone.back().posed = view.posed.subspan(n, 1);
    }
    return alone;
  }

 private:
  struct Lists {
    std::vector<RenderInstance> instances, all;
    std::vector<PosedModel> posed;
    std::vector<std::uint32_t> numbers;
    std::vector<RigidTransform> bodies;
  };

  std::array<std::vector<AttachedModel>, 2> robots_;
  std::vector<Lists> lists_;
  std::vector<RenderView> mixed_, as_instances_, numbered_;
};

/// Expects images of MixedModels::numbered() to be those of mixed() but for the numbers, which are
/// where a posed model is in front of all else. `draw` makes images of views.
template <class Draw>
void expectNumbers(const MixedModels& models, const Draw& draw) {
  const RenderImages plain = draw(models.mixed());
  const RenderImages numbered = draw(models.numbered());
  EXPECT_EQ(numbered.color, plain.color);
  EXPECT_EQ(numbered.depth, plain.depth);
  // Those of the pack, unless a posed model is at this distance; if several are, any of their
  // numbers.
  std::vector<std::vector<std::uint32_t>> wanted(plain.semantics.size());
  for (std::size_t n = 0; n < MixedModels::kOfEach; ++n) {
    const RenderImages alone = draw(models.posedAlone(n));
    for (std::size_t pixel = 0; pixel < wanted.size(); ++pixel) {
      const bool is_seen = alone.depth[pixel] > 0 && alone.depth[pixel] == plain.depth[pixel];
      if (is_seen) wanted[pixel].push_back(MixedModels::number(n));
    }
  }
  std::size_t with_number = 0;
  for (std::size_t pixel = 0; pixel < wanted.size(); ++pixel) {
    const std::uint32_t found = numbered.semantics[pixel];
    if (wanted[pixel].empty()) {
      ASSERT_EQ(found, plain.semantics[pixel]) << pixel;
    } else {
      ++with_number;
      ASSERT_THAT(wanted[pixel], testing::Contains(found)) << pixel;
    }
  }
  EXPECT_GT(with_number, wanted.size() / 20);
  EXPECT_LT(with_number, wanted.size() * 19 / 20);
}

}  // namespace galactic::test
