#pragma once

namespace galactic::simulation {

/// A move in the ground plane by which something gets free, meters; (0, 0) for none.
struct Push {
  float x = 0;
  float z = 0;
};

/// Adds up pushes so that their order changes nothing: the largest in each of the four directions
/// of the axes, opposite ones against each other.
class PushSum {
 public:
  void add(const Push& push) noexcept;
  /// At most `longest` meters long; (0, 0) when nothing was added or pushes cancel out.
  [[nodiscard]] Push total(float longest) const noexcept;

 private:
  float least_x_ = 0;
  float most_x_ = 0;
  float least_z_ = 0;
  float most_z_ = 0;
};

}  // namespace galactic::simulation
