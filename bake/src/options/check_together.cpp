#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <string_view>
#include <vector>

#include "galactic/bake/job_lists.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// An option that has no effect unless another one is given.
struct Need {
  std::string_view option;
  std::string_view other;
  const char* message;
};
constexpr std::array<Need, 2> kNeeds{
    {{"held-out", "split", "is about `split`; add it, or leave this out"},
     {"split-seed", "split", "is about `split`; add it, or leave this out"}}};

constexpr std::array<std::string_view, 4> kDrawn{"render-error", "texture-size", "texture-format",
                                                 "lighting"};

Result<void> checkDrawing(const DrawOptions& draw, const OptionReader& given) {
  for (const std::string_view option : kDrawn) {
    if (draw.wanted || !given.isGiven(option)) continue;
    return given.refuse(option, "does not go with `no-render-meshes`; leave one of them out");
  }
  return {};
}

/// Checks the radii before anything is baked, so that the error names the place where they are
/// given.
Result<void> checkRadii(const std::vector<float>& radii, const OptionReader& given) {
  const auto found = std::ranges::adjacent_find(radii, std::greater_equal<>());
  if (found == radii.end()) return {};
  return given.refuse("radii",
                      fmt::format("has {} m after {} m; list each radius once, in ascending order",
                                  *std::next(found), *found));
}

Result<void> checkOne(const SceneJob& job, const OptionReader& given) {
  RETURN_IF_ERROR(checkRadii(job.grids.radii, given));
  const bool has_components = given.isGiven("keep-components");
  if (has_components && given.isGiven("inside")) {
    return given.refuse("keep-components",
                        "does not go with `inside`, whose free parts are the room; leave one of "
                        "them out");
  }
  if (job.grids.free_space.keep == Keep::kAll && (has_components || given.isGiven("inside"))) {
    return given.refuse(has_components ? "keep-components" : "inside",
                        "says what the room is, and `keep` all stores everything; leave one of "
                        "them out");
  }
  return checkDrawing(job.draw, given);
}

/// The boxes of a collection are in the frame of the mesh files.
Result<void> checkOne(const ObjectJob& job, const OptionReader& given) {
  RETURN_IF_ERROR(checkRadii(job.shape.spheres.radii, given));
  if (!job.collection.empty() && (!job.import.up || job.import.transform)) {
    return given.refuse("collection",
                        "needs the up axis of the meshes, in whose frame its boxes stand: give "
                        "`up`, and no `transform`");
  }
  return checkDrawing(job.draw, given);
}

Result<void> checkOne(const RobotJob& job, const OptionReader& given) {
  RETURN_IF_ERROR(checkRadii(job.shape.radii, given));
  return checkDrawing(job.draw, given);
}

template <class Other>
Result<void> checkOne(const Other& /*job*/, const OptionReader& /*given*/) {
  return {};
}

}  // namespace

Result<void> checkTogether(const Job& job, const OptionReader& given) {
  for (const Need& need : kNeeds) {
    if (given.isGiven(need.option) && !given.isGiven(need.other)) {
      return given.refuse(need.option, need.message);
    }
  }
  return std::visit([&](const auto& one) { return checkOne(one, given); }, job);
}

Result<void> checkTogether(const DatasetJobs& dataset, const OptionReader& given) {
  if (given.isGiven("inside")) {
    return given.refuse("inside", "is a point of one scene, and a dataset has many; leave it out");
  }
  return checkOne(dataset.scene, given);
}

}  // namespace galactic::bake
