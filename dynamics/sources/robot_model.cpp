#include "dynamics/sources/robot_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

#include "dynamics/sources/body_ranges.h"
#include "support/try.h"

namespace galactic::dynamics {
namespace {

/// Rounded numbers in real files may violate the inequality of moments by this share.
constexpr double kMomentSlack = 0.01;

struct Box {
  std::array<double, 3> least{};
  std::array<double, 3> most{};

  [[nodiscard]] double size(std::size_t axis) const { return most[axis] - least[axis]; }
};

std::array<double, 3> toArray(const Vec3& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

std::optional<Box> boxAround(const std::vector<HullPoints>& hulls) {
  std::optional<Box> box;
  for (const HullPoints& hull : hulls) {
    for (const Vec3& point : hull) {
      const std::array<double, 3> p = toArray(point);
      if (!box) box = Box{p, p};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        box->least[axis] = std::min(box->least[axis], p[axis]);
        box->most[axis] = std::max(box->most[axis], p[axis]);
      }
    }
  }
  return box;
}

std::array<double, 6> momentsOfBox(double mass, const Box& box) {
  const double xx = box.size(0) * box.size(0);
  const double yy = box.size(1) * box.size(1);
  const double zz = box.size(2) * box.size(2);
  return {mass / 12 * (yy + zz), mass / 12 * (xx + zz), mass / 12 * (xx + yy), 0, 0, 0};
}

std::array<double, 3> middleOf(const Box& box) {
  std::array<double, 3> middle{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    middle[axis] = (box.least[axis] + box.most[axis]) / 2;
  }
  return middle;
}

Inertia inertiaOfBox(double mass, const Box& box) {
  return {.mass = mass, .center = middleOf(box), .moments = momentsOfBox(mass, box)};
}

/// The eigenvalues of a symmetric 3 x 3 matrix (Smith 1961), ascending.
std::array<double, 3> eigenvaluesOf(const std::array<double, 6>& m) {
  const double off = m[3] * m[3] + m[4] * m[4] + m[5] * m[5];
  const double mean = (m[0] + m[1] + m[2]) / 3;
  const double spread = (m[0] - mean) * (m[0] - mean) + (m[1] - mean) * (m[1] - mean) +
                        (m[2] - mean) * (m[2] - mean) + 2 * off;
  const double p = std::sqrt(spread / 6);
  if (!(p > 0)) return {mean, mean, mean};
  const double a = (m[0] - mean) / p;
  const double b = (m[1] - mean) / p;
  const double c = (m[2] - mean) / p;
  const double d = m[3] / p;
  const double e = m[4] / p;
  const double f = m[5] / p;
  const double half = (a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e)) / 2;
  const double phi = std::acos(std::clamp(half, -1.0, 1.0)) / 3;
  constexpr double kThirdOfTurn = 2.0943951023931953;
  std::array<double, 3> values{mean + 2 * p * std::cos(phi),
                               mean + 2 * p * std::cos(phi + kThirdOfTurn),
                               mean + 2 * p * std::cos(phi - kThirdOfTurn)};
  std::ranges::sort(values);
  return values;
}

bool canBeMoments(const std::array<double, 6>& moments) {
  const auto is_small = [](double m) { return std::abs(m) <= kMoments.most; };
  if (!std::ranges::all_of(moments, is_small)) return false;
  const std::array<double, 3> principal = eigenvaluesOf(moments);
  return contains(kMoments, principal[0]) && contains(kMoments, principal[2]) &&
         principal[2] <= (principal[0] + principal[1]) * (1 + kMomentSlack);
}

/// Turns (x, y, z) into (x, z, -y), as importRobot does.
Inertia yUp(const bake::LinkInertial& stated) {
  const auto& [x, y, z] = stated.center;
  const auto& [xx, yy, zz, xy, xz, yz] = stated.moments;
  return {.mass = stated.mass, .center = {x, z, -y}, .moments = {xx, zz, yy, xz, -xy, -yz}};
}

/// The inertia of a link from the robot's file, or a substitute; none for a bare frame.
class LinkInertias {
 public:
  /// `file`: its name, for warnings.
  LinkInertias(std::string_view file, const RobotDefaults& defaults,
               std::vector<std::string>& warnings)
      : file_(file), defaults_(defaults), warnings_(warnings) {}

  /// `stated` may be null.
  std::optional<Inertia> of(std::string_view link, const bake::LinkInertial* stated,
                            const std::vector<HullPoints>& hulls) {
    const std::optional<Box> box = boxAround(hulls);
    if (stated == nullptr) return without(link, box, "has no <inertial>");
    if (!contains(kMasses, stated->mass)) {
      const std::string why = fmt::format("has a mass of {:g} kg in '{}', {}", stated->mass, file_,
                                          expectedText(kMasses));
      // Many files give bare frames a mass of 0.
      if (!box && stated->mass != 0) {
        warnings_.push_back(fmt::format("link '{}' {}; it has none now", link, why));
      }
      return without(link, box, why);
    }
    const Box solid = thickened(box.value_or(smallBox()));
    Inertia inertia = yUp(*stated);
    if (!std::ranges::all_of(inertia.center, [](double c) { return contains(kCenters, c); })) {
      inertia.center = middleOf(solid);
      warnings_.push_back(
          fmt::format("link '{}' has a center of mass in '{}' that is farther than {:g} m from its "
                      "origin along an axis; that of a box around its shape counts",
                      link, file_, kCenters.most));
    }
    if (canBeMoments(stated->moments)) return inertia;
    inertia.moments = momentsOfBox(stated->mass, solid);
    warnings_.push_back(
        fmt::format("link '{}' has moments of inertia in '{}' that no body has; those of a box "
                    "around its shape count",
                    link, file_));
    return inertia;
  }

  /// The inertia of a body whose links have neither mass nor shape.
  Inertia ofNothing(std::string_view link) {
    warnings_.push_back(fmt::format("link '{}' moves and has neither mass nor shape; {} kg count",
                                    link, defaults_.least_mass));
    return inertiaOfBox(defaults_.least_mass, smallBox());
  }

 private:
  [[nodiscard]] Box smallBox() const {
    const double half = defaults_.least_size / 2;
    return {{-half, -half, -half}, {half, half, half}};
  }

  /// A flat box would have no moment about some axis, so give it a thickness.
  [[nodiscard]] Box thickened(Box box) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double lack = std::max(defaults_.least_size / 5 - box.size(axis), 0.0);
      box.least[axis] -= lack / 2;
      box.most[axis] += lack / 2;
    }
    return box;
  }

  std::optional<Inertia> without(std::string_view link, const std::optional<Box>& box,
                                 std::string_view why) {
    if (!box) return std::nullopt;
    const double volume = box->size(0) * box->size(1) * box->size(2);
    const double mass = std::max(defaults_.density * volume, defaults_.least_mass);
    warnings_.push_back(
        fmt::format("link '{}' {}; {:.3g} kg count, by the box around its shape", link, why, mass));
    return inertiaOfBox(mass, thickened(*box));
  }

  std::string_view file_;
  const RobotDefaults& defaults_;
  std::vector<std::string>& warnings_;
};

using Matrix = std::array<std::array<double, 3>, 3>;

Matrix rotationOf(const Pose& pose) {
  Matrix m{};
  const std::array<Vec3, 3> columns{rotate(pose.rotation, {1, 0, 0}),
                                    rotate(pose.rotation, {0, 1, 0}),
                                    rotate(pose.rotation, {0, 0, 1})};
  for (std::size_t c = 0; c < 3; ++c) {
    const std::array<double, 3> column = toArray(columns[c]);
    for (std::size_t r = 0; r < 3; ++r) m[r][c] = column[r];
  }
  return m;
}

Matrix matrixOf(const std::array<double, 6>& m) {
  return {{{m[0], m[3], m[4]}, {m[3], m[1], m[5]}, {m[4], m[5], m[2]}}};
}

std::array<double, 6> momentsOf(const Matrix& m) {
  return {m[0][0], m[1][1], m[2][2], m[0][1], m[0][2], m[1][2]};
}

/// The same inertia seen from the frame a of `a_from_b`.
Inertia moved(const Pose& a_from_b, const Inertia& inertia) {
  const Matrix r = rotationOf(a_from_b);
  const Matrix m = matrixOf(inertia.moments);
  Matrix turned{};
  Inertia result{.mass = inertia.mass, .center = toArray(a_from_b.translation), .moments = {}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      result.center[i] += r[i][k] * inertia.center[k];
      for (std::size_t j = 0; j < 3; ++j) {
        for (std::size_t l = 0; l < 3; ++l) turned[i][j] += r[i][k] * m[k][l] * r[j][l];
      }
    }
  }
  result.moments = momentsOf(turned);
  return result;
}

/// Adds the moments that `inertia` has about `center` to `moments` (parallel axes).
void addAbout(const std::array<double, 3>& center, const Inertia& inertia,
              std::array<double, 6>& moments) {
  std::array<double, 3> d{};
  for (std::size_t axis = 0; axis < 3; ++axis) d[axis] = inertia.center[axis] - center[axis];
  const double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  const std::array<double, 6> shift{square - d[0] * d[0], square - d[1] * d[1],
                                    square - d[2] * d[2], -d[0] * d[1],
                                    -d[0] * d[2],         -d[1] * d[2]};
  for (std::size_t n = 0; n < 6; ++n) moments[n] += inertia.moments[n] + inertia.mass * shift[n];
}

Inertia sumOf(const std::vector<Inertia>& parts) {
  Inertia sum;
  for (const Inertia& part : parts) {
    sum.mass += part.mass;
    for (std::size_t axis = 0; axis < 3; ++axis) sum.center[axis] += part.mass * part.center[axis];
  }
  for (double& coordinate : sum.center) coordinate /= sum.mass;
  for (const Inertia& part : parts) addAbout(sum.center, part, sum.moments);
  return sum;
}

/// The body to which each link belongs.
std::vector<std::uint32_t> groupLinks(const Robot& robot) {
  std::vector<std::uint32_t> body_of_link;
  std::uint32_t bodies = 0;
  for (const LinkFrame& link : robot.links()) {
    const auto moves = [&](const ControlledJoint& joint) {
      return link.position == static_cast<std::int32_t>(joint.position);
    };
    const bool is_moved = link.parent < 0 || std::ranges::any_of(robot.controlledJoints(), moves);
    body_of_link.push_back(is_moved ? bodies++
                                    : body_of_link[static_cast<std::size_t>(link.parent)]);
  }
  return body_of_link;
}

/// Gives a mass to bodies that have none.
void completeBodies(const Robot& robot, LinkInertias& inertias, RobotParts& parts) {
  std::vector<std::uint32_t> first;
  std::vector<bool> has_mass;
  for (std::uint32_t i = 0; i < parts.links.size(); ++i) {
    if (parts.body_of_link[i] == first.size()) {
      first.push_back(i);
      has_mass.push_back(false);
    }
    if (parts.links[i].inertia) has_mass[parts.body_of_link[i]] = true;
  }
  for (std::size_t body = 0; body < first.size(); ++body) {
    if (has_mass[body]) continue;
    parts.links[first[body]].inertia = inertias.ofNothing(robot.linkName(first[body]));
  }
}

}  // namespace

Result<RobotParts> robotParts(const RobotSource& source, const Robot& robot,
                              const RobotDefaults& defaults) {
  std::map<std::string_view, const bake::SourceLink*> by_name;
  for (const bake::SourceLink& link : source.robot.links) by_name.emplace(link.name, &link);
  std::map<std::string_view, const bake::LinkInertial*> stated;
  for (const bake::LinkInertial& one : source.inertials) stated.emplace(one.link, &one);
  RobotParts parts;
  parts.body_of_link = groupLinks(robot);
  LinkInertias inertias(source.file, defaults, parts.warnings);
  for (std::size_t i = 0; i < robot.links().size(); ++i) {
    const auto found = by_name.find(robot.linkName(i));
    if (found == by_name.end()) {
      return fail(ErrorCode::kInvalidInput, source.robot.name,
                  fmt::format("has no link '{}', which the robot's pack has; give the recipe that "
                              "the pack was baked from, or bake it again",
                              robot.linkName(i)));
    }
    LinkPart& part = parts.links.emplace_back();
    part.hulls = hullPointsOf(source.robot, *found->second);
    RETURN_IF_ERROR(checkExtents(
        part.hulls, fmt::format("{}: link '{}'", source.robot.name, robot.linkName(i))));
    const auto mass = stated.find(robot.linkName(i));
    part.inertia =
        inertias.of(robot.linkName(i), mass == stated.end() ? nullptr : mass->second, part.hulls);
  }
  completeBodies(robot, inertias, parts);
  return parts;
}

std::vector<RobotBody> bodiesOf(const RobotParts& parts, const Robot& robot,
                                std::span<const float> positions) {
  const std::span<const LinkFrame> links = robot.links();
  std::vector<Pose> root_from_link(links.size());
  forwardKinematics(links, {}, positions, root_from_link);
  std::vector<RobotBody> bodies;
  std::vector<std::vector<Inertia>> inertias;
  for (std::uint32_t i = 0; i < links.size(); ++i) {
    const std::uint32_t number = parts.body_of_link[i];
    if (number == bodies.size()) {
      RobotBody& body = bodies.emplace_back();
      inertias.emplace_back();
      body.link = i;
      if (i > 0) {
        const auto above = static_cast<std::size_t>(links[i].parent);
        body.parent = static_cast<int>(parts.body_of_link[above]);
        const Pose& root_from_body = root_from_link[bodies[parts.body_of_link[above]].link];
        body.parent_from_joint =
            inverse(root_from_body) * root_from_link[above] * links[i].parent_from_joint;
      }
    }
    const Pose body_from_link = inverse(root_from_link[bodies[number].link]) * root_from_link[i];
    bodies[number].links.push_back({i, body_from_link});
    const std::optional<Inertia>& inertia = parts.links[i].inertia;
    if (inertia) inertias[number].push_back(moved(body_from_link, *inertia));
  }
  for (std::size_t n = 0; n < bodies.size(); ++n) bodies[n].inertia = sumOf(inertias[n]);
  return bodies;
}

}  // namespace galactic::dynamics
