#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "galactic/batch_simulator.h"
#include "simulator.h"

namespace galactic::python {

/// The return and length of each env's episode, and which episodes the last step ended: everything
/// that a vector environment reports about a step, in one pass over the envs where numpy would need
/// twenty calls.
class EpisodeTally {
 public:
  /// The simulator must outlive the tally.
  explicit EpisodeTally(Simulator& simulator);

  /// Adds the last step: its rewards, float32 (num_envs,), and the ends of episodes in it, uint8
  /// (num_envs,), from the simulator or from a user-defined task. Returns terminations and
  /// truncations, bool (num_envs,), and the numbers of the envs whose episodes ended, int64, in
  /// order.
  [[nodiscard]] py::tuple add(const py::object& rewards, const py::object& endings);

  /// Describes the episodes that the last added step ended, in arrays (num_envs,) with zeros for
  /// all other envs: "ended" bool, "r" float32, "l" int64, "ending" uint8, "success" bool, "picked"
  /// bool (whether the target was in the hand at any time), "episode_index" int32 (-1 for other
  /// envs). Resets the sums of these envs for the episodes that they are in now.
  [[nodiscard]] py::dict takeEnded();

  /// Resets the sums of the envs in `mask`, bool (num_envs,). Every env may be in a different
  /// episode now.
  void restart(const py::object& mask);

  /// Continues from earlier values of returns() and lengths().
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
  /// The envs whose episodes the last added step ended, how they ended, and whether the target was
  /// in the hand at any time.
  std::vector<std::size_t> ended_;
  std::vector<std::uint8_t> endings_;
  std::vector<bool> picked_;
};

}  // namespace galactic::python
