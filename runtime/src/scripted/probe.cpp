#include "scripted/probe.h"

#include <algorithm>
#include <cmath>

#include "simulation/phases/move.h"

namespace galactic::scripted {
namespace {

constexpr std::size_t kBitsPerWord = 64;

SphereCloud cloudOf(const Robot& robot) {
  std::vector<SphereCloud::Sphere> spheres;
  spheres.reserve(robot.spheres().size());
  for (const SphereGroup& group : robot.groups()) {
    for (const SetSphere& sphere : group.spheres) spheres.push_back({group.link, sphere});
  }
  return {spheres, robot.radii()};
}

std::size_t mostSpheres(const World& world) {
  std::size_t most = world.robot().spheres().size();
  for (const Episode& episode : world.episodes().episodes()) {
    for (const Placement& placement : world.episodes().placements(episode)) {
      most = std::max(most, world.objectOf(placement).spheres.size());
    }
  }
  return simulation::paddedToLanes(most) + simulation::kLanes * world.radii().size();
}

}  // namespace

Probe::Probe(const World& world, const SimulationOptions& options)
    : world_(world),
      options_(options),
      arm_(world.robot()),
      root_height_(world.robot().base()->root_height),
      resting_(world.mostObjects(), world.radii().back()),
      robot_(cloudOf(world.robot())),
      collision_(mostSpheres(world)),
      placement_(mostSpheres(world), world.radii()) {
  // A jitter is random; what is planned shall not be.
  options_.placement.attempts = 1;
}

void Probe::look(const EnvState& state) {
  const Episode& episode = world_.episodes().episodes()[state.episode];
  std::span<const Placement> placements = world_.episodes().placements(episode);
  if (!options_.task.distractors) placements = placements.subspan(episode.target, 1);
  scene_ = &world_.scenes()[state.scene];
  models_.clear();
  resting_.clear();
  held_ = nullptr;
  for (std::uint32_t n = 0; n < placements.size(); ++n) {
    models_.push_back(&world_.objectOf(placements[n]));
    if (static_cast<std::int32_t>(n) == state.held) continue;
    resting_.insert(n, simulation::restingBox(models_[n]->box, state.objects[n]));
  }
  poses_ = state.objects;
  if (state.held < 0) return;
  const auto held = static_cast<std::uint32_t>(state.held);
  hold(held, inverse(state.world_from_grip) * state.objects[held]);
}

void Probe::pretendToHold(std::uint32_t number, const BasePlace& base,
                          std::span<const float> positions) {
  const Pose world_from_grip = worldFromRoot(base) * arm_.gripOf(arm_.placeLinks(positions));
  resting_.remove(number);
  hold(number, inverse(world_from_grip) * poses_[number]);
}

void Probe::pretendNoMore() {
  held_ = nullptr;
  resting_.insert(held_number_,
                  simulation::restingBox(models_[held_number_]->box, poses_[held_number_]));
}

void Probe::hold(std::uint32_t number, const Pose& grip_from_object) {
  held_number_ = number;
  held_ = models_[number];
  grip_from_object_ = grip_from_object;
  std::vector<SphereCloud::Sphere> spheres;
  spheres.reserve(held_->spheres.size());
  for (const SetSphere& sphere : held_->spheres) spheres.push_back({0, sphere});
  held_spheres_ = SphereCloud(spheres, world_.radii());
  const std::size_t words = (held_spheres_.paddedCount() + kBitsPerWord - 1) / kBitsPerWord;
  touching_.assign(words, 0);
  ignored_.assign(words, 0);
}

Pose Probe::worldFromRoot(const BasePlace& base, float root_height) {
  const float half = 0.5F * base.yaw;
  return {base.position + Vec3{0, root_height, 0}, {0, std::sin(half), 0, std::cos(half)}};
}

Pose Probe::worldFromRoot(const BasePlace& base) const { return worldFromRoot(base, root_height_); }

std::optional<float> Probe::floorAt(float x, float z, float from) const {
  const simulation::FloorUnder under =
      simulation::floorUnder(*scene_, {x, from, z}, options_.ground);
  if (under.floor != simulation::Floor::kCarries) return std::nullopt;
  return under.height;
}

void Probe::setArm(std::span<const float> positions) {
  const std::span<const Pose> links = arm_.placeLinks(positions);
  robot_.assemble(links);
  robot_reach_ = robot_.reach();
  if (held_ == nullptr) return;
  const Pose root_from_object = arm_.gripOf(links) * grip_from_object_;
  held_spheres_.assemble(std::span(&root_from_object, 1));
}

bool Probe::isFreeAt(const BasePlace& base) {
  if (simulation::penetrates({*scene_, resting_}, robot_.at(base, root_height_))) return false;
  return held_ == nullptr || heldIsFree(held_spheres_.at(base, root_height_));
}

bool Probe::isFreeOfScene(const BasePlace& base) {
  const simulation::SphereBatch spheres = robot_.at(base, root_height_);
  return std::ranges::all_of(spheres.ranges, [&](const simulation::RadiusRange& range) {
    const std::size_t count = simulation::paddedToLanes(range.count);
    const SphereCenters centers{{spheres.x + range.first, count},
                                {spheres.y + range.first, count},
                                {spheres.z + range.first, count}};
    return scene_->grids()[range.radius_index].firstNotFree(centers) == count;
  });
}

bool Probe::isFreeOfRest(const BasePlace& base) {
  if (isAnyNear(base.position) && resting_.touches(robot_.at(base, root_height_))) return false;
  return held_ == nullptr || heldIsFree(held_spheres_.at(base, root_height_));
}

bool Probe::isAnyNear(const Vec3& position) const {
  for (std::uint32_t n = 0; n < resting_.capacity(); ++n) {
    if (!resting_.isResting(n)) continue;
    const simulation::RestingBox& box = resting_.box(n);
    const Vec3 half = box.half_extents;
    const float x = box.center.x - position.x;
    const float z = box.center.z - position.z;
    const float reach = robot_reach_ + std::sqrt(dot(half, half));
    if (x * x + z * z < reach * reach) return true;
  }
  return false;
}

bool Probe::heldIsFree(const simulation::SphereBatch& spheres) {
  if (!simulation::penetrates({*scene_, resting_}, spheres)) return true;
  simulation::penetrating({*scene_, resting_}, spheres, collision_, touching_);
  std::uint64_t any = 0;
  for (std::size_t w = 0; w < touching_.size(); ++w) any |= touching_[w] & ~ignored_[w];
  return any == 0;
}

void Probe::findTouching(const BasePlace& base, std::span<const float> positions) {
  setArm(positions);
  simulation::penetrating({*scene_, resting_}, held_spheres_.at(base, root_height_), collision_,
                          touching_);
}

void Probe::ignoreTouching(const BasePlace& base, std::span<const float> positions) {
  if (held_ == nullptr) return;
  findTouching(base, positions);
  ignored_ = touching_;
}

void Probe::keepTouching(const BasePlace& base, std::span<const float> positions) {
  if (held_ == nullptr) return;
  findTouching(base, positions);
  for (std::size_t w = 0; w < ignored_.size(); ++w) ignored_[w] &= touching_[w];
}

std::optional<Pose> Probe::landing(const BasePlace& base, std::span<const float> positions) {
  const Pose released =
      worldFromRoot(base) * (arm_.gripOf(arm_.placeLinks(positions)) * grip_from_object_);
  simulation::RandomStream random(0, 0, 0, 0);
  const simulation::Landing landing = simulation::placeObject(
      {*scene_, resting_}, *held_, released, random, options_.placement, placement_);
  if (!landing.placed) return std::nullopt;
  return landing.pose;
}

}  // namespace galactic::scripted
