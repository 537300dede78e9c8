#include "run/learned_run.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "drawing/rendering.h"
#include "galactic/learned_policy.h"
#include "galactic/option_text.h"
#include "galactic/world_models.h"
#include "galactic/world_views.h"
#include "support/option_rules.h"
#include "support/try.h"

namespace galactic {
namespace {

/// The camera that the policy in `pack` was trained with.
CameraWish wishOf(const PolicyImage& image, const CameraJitter& jitter, const std::string& pack) {
  return {.name = image.camera,
          .fov_degrees = image.fovDegrees(),
          .position = image.position,
          .rpy_degrees = image.rpy_degrees,
          .near = image.near,
          .jitter = jitter,
          .options = {.camera = pack, .fov = pack, .position = pack, .rpy = pack, .near = pack}};
}

/// Draws the images that a policy sees. Must not move, because its parts refer to each other.
class PolicyEyes {
 public:
  static Result<std::unique_ptr<PolicyEyes>> create(const PolicyImage& image, const World& world,
                                                    const BatchSimulator& simulator,
                                                    const RunOptions& run) {
    ASSIGN_OR_RETURN(const ChosenCamera camera,
                     chooseCamera(world.robot(), wishOf(image, run.drawing.jitter, run.policy)));
    ASSIGN_OR_RETURN(WorldModels models, WorldModels::from(world));
    auto eyes = std::unique_ptr<PolicyEyes>(new PolicyEyes(std::move(models)));
    RenderOptions options;
    options.width = image.width;
    options.height = image.height;
    options.color = image.color ? ColorFormat::kRgba8 : ColorFormat::kNone;
    options.depth = image.depth;
    options.near = camera.near;
    options.backend = run.drawing.backend;
    options.device = run.drawing.device;
    options.noise = noiseFor(run.drawing.noise, options);
    options.threads = run.simulation.threads;
    ASSIGN_OR_RETURN(eyes->images_,
                     ImageBatch::create(eyes->models_.library(), options, simulator.envCount()));
    eyes->views_.emplace(eyes->models_, simulator, camera.mount);
    return eyes;
  }

  void look(const BatchSimulator& simulator) {
    views_->update(simulator);
    images_->begin(views_->views());
    images_->end();
  }
  [[nodiscard]] std::span<const std::uint8_t> color() const { return images_->color(); }
  [[nodiscard]] std::span<const float> depth() const { return images_->depth(); }

 private:
  explicit PolicyEyes(WorldModels models) : models_(std::move(models)) {}

  WorldModels models_;
  std::optional<WorldViews> views_;
  std::optional<ImageBatch> images_;
};

/// Fails if noise was requested for images that are drawn neither for the policy nor for people.
Result<void> checkNoise(const OpenedPolicy& policy, const DrawingOptions& drawing) {
  const std::optional<PolicyImage>& image = policy.needs.image;
  const bool has_depth = drawing.hasDepth() || (image && image->depth);
  const bool has_color = drawing.hasColor() || (image && image->color);
  const auto refuse = [&](const char* images) {
    return fail(
        ErrorCode::kInvalidInput, policy.pack.where(),
        fmt::format("this policy sees no {}, and nobody else does, but noise or jitter of it "
                    "was asked for; leave that out, or add --render",
                    images));
  };
  if (drawing.noise.changesDepth() && !has_depth) return refuse("depth");
  if (drawing.noise.changesColor() && !has_color) return refuse("color");
  if (drawing.jitter.isOn() && !has_depth && !has_color) return refuse("image");
  return {};
}

/// A network as a policy: it gets the simulator's observations, and images.
class NetworkPolicy final : public Policy {
 public:
  NetworkPolicy(LearnedPolicy policy, const BatchSimulator& simulator,
                std::unique_ptr<PolicyEyes> eyes)
      : policy_(std::move(policy)), simulator_(simulator), eyes_(std::move(eyes)) {}

  Result<void> act(std::uint64_t, std::span<float> actions) override {
    PolicyInputs inputs{.observations = simulator_.observations(),
                        .dones = simulator_.dones(),
                        .color = {},
                        .depth = {}};
    if (eyes_) {
      eyes_->look(simulator_);
      inputs.color = eyes_->color();
      inputs.depth = eyes_->depth();
    }
    policy_.act(inputs, actions);
    return {};
  }

  void restart(std::uint32_t first_env) override { policy_.reset(first_env); }

 private:
  LearnedPolicy policy_;
  const BatchSimulator& simulator_;
  std::unique_ptr<PolicyEyes> eyes_;
};

}  // namespace

Result<OpenedPolicy> openPolicy(const RunOptions& options) {
  ASSIGN_OR_RETURN(
      PackFile pack,
      PackFile::open(options.policyFile(), options.trusted ? Trust::kTrusted : Trust::kVerify));
  ASSIGN_OR_RETURN(PolicyInterface needs, policyInterface(pack));
  return OpenedPolicy{std::move(pack), std::move(needs)};
}

Result<void> applyNeeds(const OpenedPolicy& policy, SimulationOptions& simulation) {
  const auto fault = setOptions(policy.needs.options, OptionScope::kTask, simulation);
  if (!fault) return {};
  return fail(ErrorCode::kInvalidInput, policy.pack.where(),
              fmt::format("needs the option {}, which is none or has no such value; verify the "
                          "pack without --trusted",
                          policy.needs.options[fault->index].name));
}

Result<std::unique_ptr<Policy>> makeLearnedPolicy(const OpenedPolicy& policy, const World& world,
                                                  const BatchSimulator& simulator,
                                                  const RunOptions& options) {
  const SimulationOptions& simulation = options.simulation;
  ASSIGN_OR_RETURN(LearnedPolicy network,
                   LearnedPolicy::create(policy.pack, policyBatchOf(simulator),
                                         {.samples = !options.is_deterministic,
                                          .seed = simulation.seed,
                                          .first_env = firstEnvOf(simulation),
                                          .threads = simulation.threads}));
  std::unique_ptr<PolicyEyes> eyes;
  RETURN_IF_ERROR(checkNoise(policy, options.drawing));
  if (policy.needs.image) {
    ASSIGN_OR_RETURN(auto made, PolicyEyes::create(*policy.needs.image, world, simulator, options));
    eyes = std::move(made);
  }
  return std::make_unique<NetworkPolicy>(std::move(network), simulator, std::move(eyes));
}

}  // namespace galactic
