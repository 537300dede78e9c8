#include <cmath>
#include <numbers>
#include <set>
#include <string_view>
#include <vector>

#include "check/asset_checks.h"
#include "check/common_check.h"
#include "check/offence.h"
#include "check/world_check.h"
#include "galactic/world_views.h"
#include "policy/layer_shapes.h"
#include "support/try.h"

namespace galactic::detail {
namespace {

using policy::LayerShape;

constexpr std::uint32_t kLargestImage = 4096;

/// Checks everything in a policy except its layers.
class PolicyChecker {
 public:
  PolicyChecker(const schema::Policy& policy, const std::string& where)
      : policy_(policy), offence_(where + ": policy") {}

  Result<void> run() {
    offence_.require(!isEmpty(policy_.name()), "name", "is empty, expected the policy's name");
    offence_.require(checkOptions(*policy_.options(), "options", offence_.where()));
    checkObservation();
    if (policy_.image() != nullptr) checkImage(*policy_.image());
    if (offence_.found()) return offence_.result();
    ASSIGN_OR_RETURN(const auto shapes, policy::layerShapes(policy_, offence_.where()));
    checkActions(shapes);
    return offence_.result();
  }

 private:
  void checkObservation() {
    std::set<std::string_view> seen;
    const auto& parts = *policy_.observation();
    for (flatbuffers::uoffset_t n = 0; n < parts.size() && !offence_.found(); ++n) {
      const std::string field = fmt::format("observation[{}]", n);
      const std::string_view name = parts.Get(n)->name()->string_view();
      offence_.require(!name.empty() && seen.insert(name).second, field + ".name",
                       "is empty or a repeated name, expected each part's own");
      offence_.require(parts.Get(n)->size() >= 1, field + ".size", "is 0, expected at least 1");
    }
  }

  void checkImage(const schema::PolicyImage& image) {
    const auto is_edge = [](std::uint32_t edge) { return edge >= 1 && edge <= kLargestImage; };
    offence_.require(is_edge(image.width()), "image.width", "is {}, expected 1 to {}",
                     image.width(), kLargestImage);
    offence_.require(is_edge(image.height()), "image.height", "is {}, expected 1 to {}",
                     image.height(), kLargestImage);
    offence_.require(image.color() || image.depth(), "image.color",
                     "and depth are false, expected one of them at least");
    offence_.require(std::isfinite(image.color_scale()), "image.color_scale",
                     "is {}, expected a finite number", image.color_scale());
    offence_.require(std::isfinite(image.depth_limit()) && image.depth_limit() > 0,
                     "image.depth_limit", "is {} m, expected a finite length above 0",
                     image.depth_limit());
    offence_.require(std::isfinite(image.depth_scale()), "image.depth_scale",
                     "is {}, expected a finite number", image.depth_scale());
    offence_.require(!isEmpty(image.camera()), "image.camera",
                     "is empty, expected a camera's name");
    offence_.require(image.vertical_fov() >= 0 && image.vertical_fov() < std::numbers::pi_v<float>,
                     "image.vertical_fov", "is {} rad, expected 0 or more, less than pi",
                     image.vertical_fov());
    offence_.require(image.near() == 0 || (image.near() >= kLeastNear && image.near() <= kMostNear),
                     "image.near", "is {} m, expected {} to {}, or 0", image.near(), kLeastNear,
                     kMostNear);
    if (image.place() != nullptr) checkPlace(*image.place());
  }

  /// Comparisons with NaN are false, so that NaN fails.
  void checkPlace(const schema::CameraPlace& place) {
    for (const float meters : {place.ahead(), place.left(), place.up()}) {
      offence_.require(std::abs(meters) <= kFarthestCamera, "image.place",
                       "is {} m away, expected {} to {}", meters, -kFarthestCamera,
                       kFarthestCamera);
    }
    for (const float degrees : {place.roll_degrees(), place.pitch_degrees(), place.yaw_degrees()}) {
      offence_.require(std::abs(degrees) <= kMostCameraTurn, "image.place",
                       "is turned by {} degrees, expected {} to {}", degrees, -kMostCameraTurn,
                       kMostCameraTurn);
    }
  }

  void checkActions(const std::vector<LayerShape>& shapes) {
    const auto& discrete = *policy_.discrete();
    offence_.require(policy_.continuous() != nullptr || discrete.size() >= 1, "discrete",
                     "is empty, and there is no continuous action, expected an action at least");
    if (const schema::ContinuousActions* continuous = policy_.continuous()) {
      offence_.require(continuous->count() >= 1, "continuous.count", "is 0, expected at least 1");
      requireVector(shapes, continuous->mean(), continuous->count(), "continuous.mean");
      requireVector(shapes, continuous->log_deviation(), continuous->count(),
                    "continuous.log_deviation");
    }
    for (flatbuffers::uoffset_t n = 0; n < discrete.size() && !offence_.found(); ++n) {
      const schema::DiscreteAction& action = *discrete.Get(n);
      const std::string field = fmt::format("discrete[{}]", n);
      const auto& values = *action.values();
      offence_.require(values.size() >= 2, field + ".values", "has {} elements, expected 2 or more",
                       values.size());
      for (const float value : values) {
        offence_.require(std::isfinite(value), field + ".values",
                         "holds {}, expected finite numbers", value);
      }
      requireVector(shapes, action.logits(), values.size(), field + ".logits");
    }
  }

  void requireVector(const std::vector<LayerShape>& shapes, std::uint32_t layer, std::size_t size,
                     const std::string& field) {
    offence_.require(layer < shapes.size(), field, "is {}, expected one of {} layers", layer,
                     shapes.size());
    if (offence_.found()) return;
    const LayerShape& shape = shapes[layer];
    offence_.require(shape.isVector() && shape.channels == size, field,
                     "leads to {} x {} x {} elements, expected a vector of {}", shape.channels,
                     shape.height, shape.width, size);
  }

  const schema::Policy& policy_;
  Offence offence_;
};

}  // namespace

Result<void> checkPolicy(const schema::Policy& policy, const std::string& where) {
  return PolicyChecker(policy, where).run();
}

}  // namespace galactic::detail
