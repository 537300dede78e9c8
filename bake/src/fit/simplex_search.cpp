#include "fit/simplex_search.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace galactic::bake::fit {
namespace {

class Simplex {
 public:
  Simplex(const std::function<double(const Vec3d&)>& function, double size) : function_(function) {
    constexpr std::array<Vec3d, 4> kCorners{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (std::size_t at = 0; at < corners_.size(); ++at)
      corners_[at] = evaluate(kCorners[at] * size);
    sort();
  }

  void step() {
    const Vec3d middle = (corners_[0].place + corners_[1].place + corners_[2].place) * (1.0 / 3);
    const Vec3d away = middle - corners_[3].place;
    const SimplexResult reflected = evaluate(middle + away);
    if (reflected.value < corners_[0].value) {
      const SimplexResult expanded = evaluate(middle + away * 2);
      corners_[3] = expanded.value < reflected.value ? expanded : reflected;
    } else if (reflected.value < corners_[2].value) {
      corners_[3] = reflected;
    } else {
      contract(middle, away, reflected);
    }
    sort();
  }

  [[nodiscard]] double size() const { return norm(corners_[3].place - corners_[0].place); }
  [[nodiscard]] const SimplexResult& best() const { return corners_[0]; }

 private:
  void contract(const Vec3d& middle, const Vec3d& away, const SimplexResult& reflected) {
    const bool outside = reflected.value < corners_[3].value;
    const SimplexResult nearer = evaluate(middle + away * (outside ? 0.5 : -0.5));
    if (nearer.value < std::min(reflected.value, corners_[3].value)) {
      corners_[3] = nearer;
      return;
    }
    for (std::size_t at = 1; at < corners_.size(); ++at) {
      corners_[at] = evaluate((corners_[0].place + corners_[at].place) * 0.5);
    }
  }

  SimplexResult evaluate(const Vec3d& place) const { return {place, function_(place)}; }

  void sort() {
    std::stable_sort(
        corners_.begin(), corners_.end(),
        [](const SimplexResult& a, const SimplexResult& b) { return a.value < b.value; });
  }

  const std::function<double(const Vec3d&)>& function_;
  std::array<SimplexResult, 4> corners_;
};

}  // namespace

SimplexResult searchSimplex(const std::function<double(const Vec3d&)>& function,
                            const SimplexOptions& options) {
  Simplex simplex(function, options.size);
  for (int step = 0; step < options.max_steps && simplex.size() > options.end_size; ++step) {
    simplex.step();
  }
  return simplex.best();
}

}  // namespace galactic::bake::fit
