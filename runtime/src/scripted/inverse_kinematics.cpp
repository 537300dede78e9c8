#include "scripted/inverse_kinematics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace galactic::scripted {
namespace {

constexpr std::size_t kRows = 6;
using Rows = std::array<double, kRows>;
using Square = std::array<Rows, kRows>;

void put(const Vec3& v, std::size_t first, double factor, Rows& rows) {
  rows[first] = factor * static_cast<double>(v.x);
  rows[first + 1] = factor * static_cast<double>(v.y);
  rows[first + 2] = factor * static_cast<double>(v.z);
}

/// Solves a x = b for a symmetric positive definite matrix (Cholesky).
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

/// The moves of the joints that bring `error` nearest to zero: J^T (J J^T + damping^2)^-1 error.
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

std::optional<Joints> solveHand(Arm& arm, const HandGoal& goal, const Joints& seed,
                                const InverseKinematicsOptions& options) {
  const std::size_t joints = arm.joints().size();
  const bool directed = options.direction_tolerance >= 0;
  const double weight = directed ? static_cast<double>(options.direction_weight) : 0.0;
  // Chord of the angle.
  const float direction_error = 2 * std::sin(0.5F * std::max(options.direction_tolerance, 0.0F));
  Joints positions = seed;
  std::vector<Arm::Column> columns(joints);
  std::vector<Rows> jacobian(joints);
  std::vector<double> moves(joints);
  for (int n = 0; n <= options.most_iterations; ++n) {
    const std::span<const Pose> links = arm.placeLinks(positions);
    const Pose grip = arm.gripOf(links);
    const Vec3 point = grip * goal.point;
    const Vec3 direction = rotate(grip.rotation, goal.direction);
    const Vec3 way = goal.place - point;
    const Vec3 turn = goal.toward - direction;
    const bool is_there = dot(way, way) <= options.tolerance * options.tolerance;
    const bool points_there = !directed || dot(turn, turn) <= direction_error * direction_error;
    if (is_there && points_there) return positions;
    arm.columns(links, columns);
    for (std::size_t joint = 0; joint < joints; ++joint) {
      const Arm::Column& column = columns[joint];
      put(cross(column.turn, point - column.origin) + column.slide, 0, 1, jacobian[joint]);
      put(cross(column.turn, direction), 3, weight, jacobian[joint]);
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
      arm.move(joint, static_cast<float>(scale * moves[joint]), positions);
    }
  }
  return std::nullopt;
}

}  // namespace galactic::scripted
