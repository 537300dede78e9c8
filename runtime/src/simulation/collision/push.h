#pragma once

namespace galactic::simulation {

/// A move in the ground plane that frees something, meters; (0, 0) for none.
struct Push {
  float x = 0;
  float z = 0;
};

/// Adds up pushes independently of their order: keeps the largest in each of the four directions of
/// the axes, and subtracts opposite ones.
class PushSum {
 public:
  void add(const Push& push) noexcept;
  /// The sum, at most `longest` meters long; (0, 0) if nothing was added or pushes cancel out.
  [[nodiscard]] Push total(float longest) const noexcept;

 private:
  float least_x_ = 0;
  float most_x_ = 0;
  float least_z_ = 0;
  float most_z_ = 0;
};

}  // namespace galactic::simulation
