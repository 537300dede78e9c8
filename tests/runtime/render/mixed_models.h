#pragma once
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
      as_instances_.push_back({.camera = views[v].camera, .instances = lists.all});
    }
  }

  [[nodiscard]] const std::vector<RenderView>& mixed() const { return mixed_; }
  [[nodiscard]] const std::vector<RenderView>& asInstances() const { return as_instances_; }

 private:
  struct Lists {
    std::vector<RenderInstance> instances, all;
    std::vector<PosedModel> posed;
    std::vector<RigidTransform> bodies;
  };

  std::array<std::vector<AttachedModel>, 2> robots_;
  std::vector<Lists> lists_;
  std::vector<RenderView> mixed_, as_instances_;
};

}  // namespace galactic::test
