#include "robot/group_spheres.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "galactic/bake/parallel_for.h"
#include "import/affine.h"
#include "sphere_set/authored_spheres.h"
#include "sphere_set/prepared_fit.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// The usual number of spheres of a robot if nobody states one; more if gaps would be too wide.
constexpr std::uint32_t kUsualSpheres = 100;

/// What to make for one group.
struct GroupPlan {
  SphereSetOptions fit;
  TriangleMesh mesh;
  /// In the group's frame.
  std::vector<HandSphere> by_hand;
  bool authored = false;
  /// The whole mesh is below the clip height, so there is nothing to cover.
  bool clipped = false;

  [[nodiscard]] bool hasSurface() const { return !mesh.triangles.empty() && !clipped; }
};

/// The settings for the whole robot, from the recipe or by default.
RecipeSpheres spheresOf(const SphereTask& task) {
  return task.recipe == nullptr ? RecipeSpheres() : task.recipe->spheres;
}

const RecipeLinkSpheres* ruleOf(const RobotRecipe* recipe, const std::string& link) {
  if (recipe == nullptr) return nullptr;
  const auto& rules = recipe->spheres.links;
  const auto found = std::find_if(rules.begin(), rules.end(), [&](const RecipeLinkSpheres& rule) {
    return rule.link.name == link;
  });
  return found == rules.end() ? nullptr : &*found;
}

/// Makes the plans of groups.
class Planner {
 public:
  explicit Planner(const SphereTask& task) : task_(task) {
    const RecipeSpheres spheres = spheresOf(task);
    eps_ = task.options.eps ? static_cast<double>(*task.options.eps) : spheres.eps;
    tau_ = task.options.tau ? static_cast<double>(*task.options.tau) : spheres.tau;
    clip_height_ = spheres.clip_height;
  }

  [[nodiscard]] GroupPlan plan(const RigidGroup& group) const {
    GroupPlan plan;
    plan.authored = task_.options.hand_spheres.has_value();
    const GroupRule rule = ruleOfGroup(group);
    for (std::size_t n = 0; n < group.links.size(); ++n) {
      addLink(group.links[n], group.group_from_link[n], plan);
    }
    plan.fit.radii = task_.options.radii;
    plan.fit.eps = static_cast<float>(rule.eps.value_or(eps_));
    plan.fit.tau = static_cast<float>(rule.tau.value_or(tau_));
    plan.fit.max_spheres = rule.max_spheres.value_or(0);
    if (!plan.mesh.triangles.empty()) {
      setBounds(plan.mesh);
      plan.fit.support = clipPlane(task_.world_from_link[group.link],
                                   static_cast<float>(rule.clip_height.value_or(clip_height_)));
      plan.clipped = isBeyond(plan.mesh, *plan.fit.support);
    }
    return plan;
  }

 private:
  /// The recipe's settings for the links of a group.
  struct GroupRule {
    std::optional<double> eps;
    std::optional<double> tau;
    std::optional<double> clip_height;
    std::optional<std::uint32_t> max_spheres;
  };

  /// If several links state a value, the one nearest to the root wins.
  [[nodiscard]] GroupRule ruleOfGroup(const RigidGroup& group) const {
    GroupRule all;
    for (const std::uint32_t link : group.links) {
      const RecipeLinkSpheres* rule = ruleOf(task_.recipe, task_.robot.links[link].name);
      if (rule == nullptr) continue;
      if (!all.eps) all.eps = rule->eps;
      if (!all.tau) all.tau = rule->tau;
      if (!all.clip_height) all.clip_height = rule->clip_height;
      if (!all.max_spheres) all.max_spheres = rule->max_spheres;
    }
    return all;
  }

  /// Adds a link's hand-made spheres and its surface.
  void addLink(std::uint32_t link, const Affine& group_from_link, GroupPlan& plan) const {
    const std::string& name = task_.robot.links[link].name;
    if (const RecipeLinkSpheres* rule = ruleOf(task_.recipe, name)) {
      plan.authored |= !rule->spheres.empty();
      addByHand(rule->spheres, group_from_link, plan);
      if (rule->skip) return;
    }
    if (task_.options.hand_spheres) {
      for (const LinkSpheres& given : task_.options.hand_spheres->links) {
        if (given.link == name) addByHand(given.spheres, group_from_link, plan);
      }
    }
    addSurface(task_.surfaces[link], group_from_link, plan.mesh);
  }

  static void addByHand(const std::vector<HandSphere>& spheres, const Affine& group_from_link,
                        GroupPlan& plan) {
    for (const HandSphere& sphere : spheres) {
      HandSphere placed = sphere;
      for (std::size_t row = 0; row < 3; ++row) {
        const double* m = &group_from_link[4 * row];
        placed.center[row] =
            m[0] * sphere.center[0] + m[1] * sphere.center[1] + m[2] * sphere.center[2] + m[3];
      }
      plan.by_hand.push_back(placed);
    }
  }

  static void addSurface(const Surface& surface, const Affine& group_from_link,
                         TriangleMesh& mesh) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vec3& position : surface.positions) {
      const auto p = transformed(group_from_link, position);
      mesh.vertices.push_back(
          {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
    }
    for (const Triangle& t : surface.triangles) {
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }

  static void setBounds(TriangleMesh& mesh) {
    mesh.bounds = {mesh.vertices.front(), mesh.vertices.front()};
    for (const Vec3& v : mesh.vertices) {
      mesh.bounds.min = {std::min(mesh.bounds.min.x, v.x), std::min(mesh.bounds.min.y, v.y),
                         std::min(mesh.bounds.min.z, v.z)};
      mesh.bounds.max = {std::max(mesh.bounds.max.x, v.x), std::max(mesh.bounds.max.y, v.y),
                         std::max(mesh.bounds.max.z, v.z)};
    }
  }

  /// The plane at `height` above the ground, in the group's frame at the start pose.
  static HalfSpace clipPlane(const Pose& world_from_group, float height) {
    const Vec3 up = rotate(conjugate(world_from_group.rotation), {0, 1, 0});
    return {up, height - world_from_group.translation.y};
  }

  /// Whether no part of the mesh is on the side of the plane where spheres are allowed.
  static bool isBeyond(const TriangleMesh& mesh, const HalfSpace& plane) {
    return std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                       [&](const Vec3& v) { return dot(plane.normal, v) <= plane.offset; });
  }

  const SphereTask& task_;
  double eps_;
  double tau_;
  double clip_height_;
};

/// Adds the link to the error, because the fitter does not know whose mesh it was.
tl::unexpected<Error> ofLink(const std::string& link, Error error) {
  error.where = fmt::format("link '{}': {}", link, error.where);
  return tl::unexpected<Error>(std::move(error));
}

Result<void> takeByHand(const GroupPlan& plan, const SphereTask& task, BakedGroup& group,
                        std::vector<std::string>& warnings) {
  const std::string& link = task.robot.links[group.link].name;
  SnappedSpheres snapped = snapRadii(plan.by_hand, plan.fit.radii);
  group.spheres.spheres = std::move(snapped.spheres);
  const double change = snapped.largest_change;
  if (change > kRadiusChangeWorthMentioning) {
    warnings.push_back(fmt::format(
        "link '{}': radii of hand-made spheres change by up to {:.1f} mm to those of the working "
        "set; choose `radii` that hold them",
        link, 1e3 * change));
  }
  if (!plan.hasSurface() || group.spheres.spheres.empty()) return {};
  auto measured =
      authoredSphereSet(plan.mesh, std::move(group.spheres.spheres), plan.fit, task.threads);
  if (!measured) return ofLink(link, measured.error());
  group.spheres = std::move(*measured);
  group.measured = true;
  return {};
}

/// How many spheres the groups without hand-made ones may have in total.
struct SphereBudget {
  /// At most this many; 0 means no limit.
  std::uint32_t most = 0;
  /// Set if nobody stated a number: takes no sets with wider gaps, however many spheres this costs.
  /// Meters.
  std::optional<double> widest_gap;
};

SphereBudget budgetOf(const SphereTask& task, std::size_t by_hand) {
  const RecipeSpheres spheres = spheresOf(task);
  const auto stated = task.options.max_spheres ? task.options.max_spheres : spheres.max_spheres;
  SphereBudget budget;
  if (!stated) budget.widest_gap = spheres.max_gap;
  const std::uint32_t most = stated.value_or(kUsualSpheres);
  if (most == 0) return budget;
  budget.most = most > by_hand ? most - static_cast<std::uint32_t>(by_hand) : 1;
  return budget;
}

/// A curve is refined as long as one of its finest sets, this many, is chosen: the next set may be
/// worth more even if the one before it is not.
constexpr std::size_t kLookAhead = 2;

/// The trade-off curves of all groups that spheres are fitted to, and the set of each that the
/// budget chooses.
class BudgetedCurves {
 public:
  BudgetedCurves(const std::vector<GroupPlan>& plans, const std::vector<RigidGroup>& groups,
                 const SphereTask& task)
      : plans_(plans), groups_(groups), task_(task), curves_(plans.size()) {}

  /// Refines each curve as far as the budget goes.
  Result<void> spend(const SphereBudget& budget) {
    std::vector<std::size_t> wanted;
    for (std::size_t n = 0; n < plans_.size(); ++n) {
      if (!plans_[n].authored && plans_[n].hasSurface()) wanted.push_back(n);
    }
    // Starts with the largest, so that all others need not wait for it at the end.
    std::stable_sort(wanted.begin(), wanted.end(),
                     [&](std::size_t a, std::size_t b) { return size(a) > size(b); });
    fitted_ = wanted;
    while (!wanted.empty()) {
      if (auto refined = refine(wanted, budget); !refined) return refined;
      chosen_ = budget.widest_gap
                    ? spendBudgetWithin(likelyPoints(), budget.most, *budget.widest_gap)
                    : spendBudget(points(), budget.most);
      std::erase_if(wanted, [&](std::size_t n) {
        return !curves_[n] || curves_[n]->complete() ||
               chosen_[n] + kLookAhead < curves_[n]->points().size();
      });
    }
    std::erase_if(fitted_, [&](std::size_t n) { return !curves_[n]; });
    if (!budget.widest_gap) chosen_ = spendBudgetEvenly(points(), budget.most);
    return {};
  }

  /// The chosen sets, one per group; none for groups that no spheres are fitted to.
  [[nodiscard]] std::vector<std::optional<SphereSet>> take() const {
    std::vector<std::optional<SphereSet>> sets(curves_.size());
    parallelFor(task_.threads, fitted_.size(), [&](std::size_t n) {
      const std::size_t group = fitted_[n];
      sets[group] = curves_[group]->take(chosen_[group]);
    });
    return sets;
  }

 private:
  [[nodiscard]] float size(std::size_t group) const {
    const Bounds& b = plans_[group].mesh.bounds;
    return (b.max.x - b.min.x) + (b.max.y - b.min.y) + (b.max.z - b.min.z);
  }

  [[nodiscard]] std::vector<CurvePoints> points() const {
    std::vector<CurvePoints> points;
    for (const auto& curve : curves_) points.push_back(curve ? curve->points() : CurvePoints());
    return points;
  }

  /// The curves with the likely widest gaps. On a large body the search points are far apart: if it
  /// counted everything that may lie between them, only the finest set would pass.
  [[nodiscard]] std::vector<CurvePoints> likelyPoints() const {
    constexpr double kUnlikely = 0.5;
    std::vector<CurvePoints> likely = points();
    for (CurvePoints& curve : likely) {
      for (CurvePoint& point : curve) point.widest_gap -= kUnlikely * point.unseen_gap;
    }
    return likely;
  }

  Result<void> refine(const std::vector<std::size_t>& groups, const SphereBudget& budget) {
    std::vector<std::optional<Error>> errors(groups.size());
    const unsigned threads = task_.threads;
    const unsigned threads_each = std::max(
        1U, threads / static_cast<unsigned>(std::min<std::size_t>(groups.size(), threads)));
    parallelFor(threads, groups.size(), [&](std::size_t n) {
      const auto refined = refineGroup(groups[n], budget.most == 0, threads_each);
      if (!refined) errors[n] = refined.error();
    });
    for (std::size_t n = 0; n < groups.size(); ++n) {
      if (errors[n]) return ofLink(task_.robot.links[groups_[groups[n]].link].name, *errors[n]);
    }
    return {};
  }

  Result<void> refineGroup(std::size_t group, bool unlimited, unsigned threads) {
    if (!curves_[group]) {
      ASSIGN_OR_RETURN(auto curve,
                       SphereCurve::begin(plans_[group].mesh, plans_[group].fit, threads));
      curves_[group] = std::move(curve);
    }
    auto refined = unlimited ? curves_[group]->finish(threads) : curves_[group]->refine(threads);
    if (refined || !sphere_set::isNothingToCover(refined.error())) return refined;
    // The part above the clip height is too small to be sampled.
    curves_[group].reset();
    return {};
  }

  const std::vector<GroupPlan>& plans_;
  const std::vector<RigidGroup>& groups_;
  const SphereTask& task_;
  std::vector<std::optional<SphereCurve>> curves_;
  /// Groups that have a curve, without those where nothing needed cover.
  std::vector<std::size_t> fitted_;
  std::vector<std::size_t> chosen_;
};

}  // namespace

Result<std::vector<BakedGroup>> makeGroupSpheres(const std::vector<RigidGroup>& groups,
                                                 const SphereTask& task,
                                                 std::vector<std::string>& warnings) {
  const Planner planner(task);
  std::vector<GroupPlan> plans;
  std::vector<BakedGroup> baked;
  std::size_t by_hand = 0;
  for (const RigidGroup& group : groups) {
    plans.push_back(planner.plan(group));
    by_hand += plans.back().by_hand.size();
    baked.push_back({.link = group.link,
                     .links = group.links,
                     .spheres = {},
                     .eps = plans.back().fit.eps,
                     .tau = plans.back().fit.tau,
                     .authored = plans.back().authored});
  }
  const SphereBudget budget = budgetOf(task, by_hand);
  BudgetedCurves curves(plans, groups, task);
  RETURN_IF_ERROR(curves.spend(budget));
  std::size_t fitted = 0;
  std::vector<std::optional<SphereSet>> sets = curves.take();
  for (std::size_t n = 0; n < plans.size(); ++n) {
    if (plans[n].authored) {
      RETURN_IF_ERROR(takeByHand(plans[n], task, baked[n], warnings));
    } else if (sets[n]) {
      baked[n].spheres = std::move(*sets[n]);
      baked[n].measured = true;
      fitted += baked[n].spheres.spheres.size();
    } else if (!plans[n].mesh.triangles.empty()) {
      warnings.push_back(fmt::format(
          "link '{}': all of it is lower than the clip height at the start pose, so it gets no "
          "spheres; lower clip_height in the recipe if it needs some",
          task.robot.links[baked[n].link].name));
    }
  }
  if (!budget.widest_gap && budget.most != 0 && fitted > budget.most) {
    warnings.push_back(fmt::format(
        "{} spheres are the fewest that cover every group of links, {} are allowed; merge links in "
        "the recipe or allow more with `max-spheres`",
        fitted, budget.most));
  }
  return baked;
}

}  // namespace galactic::bake
