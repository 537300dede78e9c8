#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "sphere_set/cover/cover_matrix.h"

namespace galactic::bake::sphere_set {

/// Chosen candidates, as indices into a pool.
using Selection = std::vector<std::uint32_t>;

/// Adds to `selection` until it covers all of the `rows` points that the pool covers: always the
/// candidate that covers most open points, of equals the one that protrudes least, then the first.
/// Gains only fall, so they are recomputed when a candidate comes up (lazy greedy).
void completeGreedily(const CandidatePool& pool, std::size_t rows, Selection& selection);

/// Removes candidates without which everything stays covered, one at a time, the one that others
/// cover best first.
void removeRedundant(const CandidatePool& pool, std::size_t rows, Selection& selection);

}  // namespace galactic::bake::sphere_set
