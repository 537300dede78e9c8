#include "scripted/inverse_kinematics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace galactic::scripted {
namespace {

constexpr std::size_t kRows = 6;
using Rows = std::array<double, kRows>;
using Square = std::array<Rows, kRows>;

/// About the vertical through the root.
constexpr Arm::Column kTurnOfBase{{0, 1, 0}, {}, {}};

void put(const Vec3& v, std::size_t first, double factor, Rows& rows) {
  rows[first] = factor * static_cast<double>(v.x);
  rows[first + 1] = factor * static_cast<double>(v.y);
  rows[first + 2] = factor * static_cast<double>(v.z);
}

/// How one joint moves a point and a direction, which is weighted by `weight`.
Rows rowsOf(const Arm::Column& column, const Vec3& point, const Vec3& direction, double weight) {
  Rows rows{};
  put(cross(column.turn, point - column.origin) + column.slide, 0, 1, rows);
  put(cross(column.turn, direction), 3, weight, rows);
  return rows;
}

/// `v` turned about +Y.
Vec3 aboutUp(const Vec3& v, float angle) {
  if (angle == 0) return v;
  return rotate(rotationOfYaw(angle), v);
}

/// Solves a x = b for a symmetric positive definite matrix a (Cholesky).
Rows solveSymmetric(Square a, Rows b) {
  for (std::size_t i = 0; i < kRows; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      double sum = a[i][k];
      for (std::size_t m = 0; m < k; ++m) sum -= a[i][m] * a[k][m];
      a[i][k] = sum / a[k][k];
    }
    double sum = a[i][i];
    for (std::size_t m = 0; m < i; ++m) sum -= a[i][m] * a[i][m];
    a[i][i] = std::sqrt(sum);
  }
  for (std::size_t i = 0; i < kRows; ++i) {
    for (std::size_t m = 0; m < i; ++m) b[i] -= a[i][m] * b[m];
    b[i] /= a[i][i];
  }
  for (std::size_t i = kRows; i-- > 0;) {
    for (std::size_t m = i + 1; m < kRows; ++m) b[i] -= a[m][i] * b[m];
    b[i] /= a[i][i];
  }
  return b;
}

/// The moves of the joints that bring `error` closest to zero: J^T (J J^T + damping^2)^-1 error.
void leastSquares(const std::vector<Rows>& jacobian, const Rows& error, double damping,
                  std::vector<double>& moves) {
  Square square{};
  for (std::size_t i = 0; i < kRows; ++i) square[i][i] = damping * damping;
  for (const Rows& column : jacobian) {
    for (std::size_t i = 0; i < kRows; ++i) {
      for (std::size_t k = 0; k < kRows; ++k) square[i][k] += column[i] * column[k];
    }
  }
  const Rows weights = solveSymmetric(square, error);
  for (std::size_t joint = 0; joint < jacobian.size(); ++joint) {
    double move = 0;
    for (std::size_t i = 0; i < kRows; ++i) move += jacobian[joint][i] * weights[i];
    moves[joint] = move;
  }
}

}  // namespace

int handFreedoms(Arm& arm, const Joints& positions, Movers movers) {
  // A direction counts like a lever of this length, meters; and the part of a column that is
  // independent of the others counts as a freedom from this length on.
  constexpr double kHand = 0.15;
  constexpr double kLeast = 0.02;
  std::vector<Arm::Column> columns(arm.joints().size());
  const std::span<const Pose> links = arm.placeLinks(positions);
  arm.columns(links, columns);
  const Pose grip = arm.gripOf(links);
  const Vec3 ahead = rotate(grip.rotation, {1, 0, 0});
  if (movers == Movers::kArmAndTurnOfBase) columns.push_back(kTurnOfBase);
  std::vector<Rows> left;
  left.reserve(columns.size());
  for (const Arm::Column& column : columns) {
    left.push_back(rowsOf(column, grip.translation, ahead, kHand));
  }
  const auto square = [](const Rows& rows) {
    double sum = 0;
    for (const double value : rows) sum += value * value;
    return sum;
  };
  // Gram-Schmidt, the longest column first.
  int freedoms = 0;
  for (; !left.empty(); ++freedoms) {
    const auto longest = std::ranges::max_element(left, {}, square);
    const double length = std::sqrt(square(*longest));
    if (length < kLeast) break;
    Rows unit = *longest;
    for (double& value : unit) value /= length;
    for (Rows& rows : left) {
      double along = 0;
      for (std::size_t i = 0; i < kRows; ++i) along += rows[i] * unit[i];
      for (std::size_t i = 0; i < kRows; ++i) rows[i] -= along * unit[i];
    }
  }
  return freedoms;
}

std::optional<Joints> solveHand(Arm& arm, const HandGoal& goal, const Joints& seed,
                                const InverseKinematicsOptions& options) {
  std::optional<TurnedHand> solved = solveHandAndTurn(arm, goal, seed, 0, options);
  if (!solved) return std::nullopt;
  return std::move(solved->joints);
}

std::optional<TurnedHand> solveHandAndTurn(Arm& arm, const HandGoal& goal, const Joints& seed,
                                           float most_turn,
                                           const InverseKinematicsOptions& options) {
  const std::size_t joints = arm.joints().size();
  const bool turns = most_turn > 0;
  const bool directed = options.direction_tolerance >= 0;
  const double weight = directed ? static_cast<double>(options.direction_weight) : 0.0;
  // The chord of the angle.
  const float direction_error = 2 * std::sin(0.5F * std::max(options.direction_tolerance, 0.0F));
  TurnedHand hand{seed, 0};
  // The base counts as one more joint.
  std::vector<Arm::Column> columns(joints + (turns ? 1 : 0));
  std::vector<Rows> jacobian(columns.size());
  std::vector<double> moves(columns.size());
  for (int n = 0; n <= options.most_iterations; ++n) {
    const std::span<const Pose> links = arm.placeLinks(hand.joints);
    const Pose grip = arm.gripOf(links);
    const Vec3 point = grip * goal.point;
    const Vec3 direction = rotate(grip.rotation, goal.direction);
    // In the frame of the root after the turn.
    const Vec3 way = aboutUp(goal.place, -hand.turn) - point;
    const Vec3 turn = aboutUp(goal.toward, -hand.turn) - direction;
    const bool is_there = dot(way, way) <= options.tolerance * options.tolerance;
    const bool points_there = !directed || dot(turn, turn) <= direction_error * direction_error;
    if (is_there && points_there) return hand;
    arm.columns(links, std::span(columns).first(joints));
    if (turns) columns.back() = kTurnOfBase;
    for (std::size_t joint = 0; joint < columns.size(); ++joint) {
      jacobian[joint] = rowsOf(columns[joint], point, direction, weight);
    }
    Rows error{};
    put(way, 0, 1, error);
    put(turn, 3, weight, error);
    leastSquares(jacobian, error, static_cast<double>(options.damping), moves);
    double most = 0;
    for (const double move : moves) most = std::max(most, std::fabs(move));
    const double longest = static_cast<double>(options.longest_move);
    const double scale = most > longest ? longest / most : 1.0;
    for (std::size_t joint = 0; joint < joints; ++joint) {
      arm.move(joint, static_cast<float>(scale * moves[joint]), hand.joints);
    }
    if (!turns) continue;
    hand.turn =
        std::clamp(hand.turn + static_cast<float>(scale * moves.back()), -most_turn, most_turn);
  }
  return std::nullopt;
}

}  // namespace galactic::scripted
