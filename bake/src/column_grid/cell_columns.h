#pragma once
#include "galactic/bake/column_engines.h"

namespace galactic::bake {

/// The columns of Coverage::kCell: free only where free over the whole square of the cell. Each
/// triangle's interval is the closed form over the square, in double precision; the square and the
/// interval are padded by kMergeTolerance and two parts in 2^23 of the grid's size, more than all
/// later float rounding together, that of queries included.
[[nodiscard]] ExactColumns cellColumns(const TriangleMesh& mesh, const GridFrame& frame,
                                       unsigned jobs);

}  // namespace galactic::bake
