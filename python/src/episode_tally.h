#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "galactic/batch_simulator.h"
#include "simulator.h"

namespace galactic::python {

/// The return and length of each env's episode, and which of them the last step ended: all that a
/// vector environment says of a step, in one pass over the envs where numpy needs twenty calls.
class EpisodeTally {
 public:
  /// The simulator outlives it.
  explicit EpisodeTally(Simulator& simulator);

  /// Takes the last step in, with what it paid, float32 (num_envs,), and how episodes ended in it,
  /// uint8 (num_envs,): the simulator's, or those of a task of one's own. Returns terminations and
  /// truncations, bool (num_envs,), and the numbers of the envs whose episodes ended, int64, in
  /// order.
  [[nodiscard]] py::tuple add(const py::object& rewards, const py::object& endings);

  /// Of the episodes that the step taken in last ended, arrays (num_envs,) with zeros for all other
  /// envs: "ended" bool, "r" float32, "l" int64, "ending" uint8, "success" bool, "picked" bool
  /// (whether the target had been in the hand), "episode_index" int32 (-1). Their sums begin anew,
  /// with the episodes that the envs are in now.
  [[nodiscard]] py::dict takeEnded();

  /// The sums of the envs in `mask`, bool (num_envs,), begin anew; any env may be in another
  /// episode now.
  void restart(const py::object& mask);

  /// Goes on from sums that returns() and lengths() showed once.
  void restore(const py::object& returns, const py::object& lengths);

  [[nodiscard]] std::span<const double> returns() const { return returns_; }
  [[nodiscard]] std::span<const std::int64_t> lengths() const { return lengths_; }

 private:
  [[nodiscard]] std::int32_t episodeOf(std::size_t env) const;
  [[nodiscard]] bool hadPicked(std::size_t env) const;

  Simulator& simulator_;
  std::vector<double> returns_;
  std::vector<std::int64_t> lengths_;
  std::vector<std::int32_t> episodes_;
  /// Envs whose episodes the step taken in last ended, how, and whether the target had been in the
  /// hand.
  std::vector<std::size_t> ended_;
  std::vector<std::uint8_t> endings_;
  std::vector<bool> picked_;
};

}  // namespace galactic::python
