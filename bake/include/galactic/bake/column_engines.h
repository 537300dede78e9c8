#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "galactic/bake/columns.h"
#include "galactic/bake/triangle_mesh.h"
#include "galactic/column_grid.h"
#include "galactic/error.h"

namespace galactic::bake {

/// What a free span promises; see schema/column_grid.fbs.
enum class Coverage { kColumn, kCell };

struct ExactColumns {
  Columns columns;
  /// Gaps between blocked intervals closed because they were within kMergeTolerance.
  std::uint64_t merged_gaps = 0;
};

/// All free spans of all columns, in closed form: the heights at which a ball touches a triangle
/// are one interval per column (the Minkowski sum of triangle and ball is convex), so a column's
/// blocked heights are a union of intervals. Exact up to float rounding (about 1e-6 m); a surface
/// whose distance is exactly the radius is a tie and may fall on either side. With Coverage::kCell,
/// the ball is swept over the whole cell and padded to allow for float rounding. Memory is
/// proportional to the number of columns. The result does not depend on `threads`.
[[nodiscard]] ExactColumns exactColumns(const TriangleMesh& mesh, const GridFrame& frame,
                                        Coverage coverage = Coverage::kColumn,
                                        unsigned threads = 1);

/// The published method (paper, appendix G), as an independent check: padded overlap tests of a
/// sphere at every step, and sphere casts up and down.
struct BulletCastOptions {
  /// Vertical step while searching inside an obstacle, meters.
  float step = 0.01F;
  /// Added to the radius in overlap tests only, meters.
  float contact_pad = 0.002F;
};

/// A mesh in Bullet, with margins of zero, ready to cast spheres along columns. Not thread-safe:
/// use one per thread. (Pimpl: no Bullet type leaves its source file.)
class BulletColumnCaster {
 public:
  explicit BulletColumnCaster(const TriangleMesh& mesh, const BulletCastOptions& options = {});
  ~BulletColumnCaster();
  BulletColumnCaster(BulletColumnCaster&&) noexcept;
  BulletColumnCaster& operator=(BulletColumnCaster&&) noexcept;

  /// Another caster for the same mesh, which both share: for another thread.
  [[nodiscard]] BulletColumnCaster another() const;

  /// Free spans of one column of `frame`, ascending.
  [[nodiscard]] std::vector<Span> column(const GridFrame& frame, ColumnIndex at) const;

 private:
  class World;
  explicit BulletColumnCaster(std::unique_ptr<World> world);
  std::unique_ptr<World> world_;
};

/// All columns by the published method, on `threads` threads. The result does not depend on their
/// number.
[[nodiscard]] Columns bulletColumns(const TriangleMesh& mesh, const GridFrame& frame,
                                    unsigned threads);

/// All columns by vertical Embree rays through triangles dilated by the radius (user geometry whose
/// intersection is the closed-form interval), on `threads` threads. The result does not depend on
/// their number. Fails with kInternal if Embree runs out of memory or does not support this
/// processor.
[[nodiscard]] Result<Columns> embreeColumns(const TriangleMesh& mesh, const GridFrame& frame,
                                            unsigned threads);

struct CastCheckOptions {
  /// Columns to replay, spread evenly over those that hold spans. Fewer, but at least 4, if very
  /// many triangles are within reach of the balls.
  std::uint32_t columns = 128;
  /// A surface whose distance differs from the radius by no more than this is a tie, meters.
  double tie_tolerance = 1e-5;
};

/// How replayed sphere casts compare with a grid; lengths in meters, summed over the sample.
struct CastCheck {
  /// Columns that were replayed.
  std::uint32_t columns = 0;
  std::uint32_t columns_differing = 0;
  double compared = 0;
  /// Differences explained by the casting method: its contact pad and its search step.
  double method = 0;
  /// Differences where the surface lies at the radius to within the tolerance.
  double ties = 0;
  /// Differences where a distance in double precision shows that the grid is wrong: must be 0.
  double errors = 0;
  /// The longest stretch of one column in which casts and grid differ because of the method.
  double longest = 0;
  /// The same because of ties.
  double longest_tie = 0;
};

/// Replays a sample of columns with Bullet and judges each disagreement by the distance to the
/// mesh, computed in double precision by brute force. `columns`: the free spans of
/// Coverage::kColumn, before regions are chosen. The result does not depend on `threads`.
[[nodiscard]] CastCheck checkWithCasts(const TriangleMesh& mesh, const Columns& columns,
                                       const BulletColumnCaster& caster,
                                       const CastCheckOptions& options = {}, unsigned threads = 1);

}  // namespace galactic::bake
