#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "arrays.h"
#include "confinement.h"
#include "galactic/batch_simulator.h"
#include "galactic/world.h"

namespace galactic::python {

class Simulator;

/// The argument `simulator`. Raises TypeError if it is something else, such as a VectorEnv.
[[nodiscard]] Simulator& simulatorOf(const py::object& given);

/// galactic.Simulator: a BatchSimulator that keeps its world alive, may be used by one thread at a
/// time, and checks whether a step is in progress. Every member needs the interpreter's lock; those
/// that take long release it while they work.
class Simulator {
 public:
  /// `keywords`: see optionsOf(). Throws what that throws, and the errors of
  /// BatchSimulator::create as an ErrorException.
  [[nodiscard]] static std::unique_ptr<Simulator> create(std::shared_ptr<const World> world,
                                                         const py::dict& keywords);

  /// `actions` and `resets` (or None) as BatchSimulator::step takes them, one row per env.
  void step(const py::object& actions, const py::object& resets);
  void beginStep(const py::object& actions, const py::object& resets);
  void endStep();
  /// `episodes`: see BatchSimulator::reset; all are checked before anything is done. Raises
  /// IndexError for numbers of no episode, and ValueError for skipped episodes.
  void reset(const py::object& episodes, bool are_drawn);
  /// Raises what reset() would raise, and does nothing else.
  void checkEpisodes(const py::object& episodes) const;
  void restart(const py::object& seed);
  /// `envs`: None for all, or numbers of envs.
  [[nodiscard]] py::bytes saveState(const py::object& envs);
  void restoreState(const py::object& state, const py::object& envs);

  /// Begins a use of the state between two steps. Raises RuntimeError during a step.
  [[nodiscard]] Confinement::Use readState();

  [[nodiscard]] const World& world() const { return *world_; }
  [[nodiscard]] const BatchSimulator& batch() const { return batch_; }
  [[nodiscard]] BatchSimulator& batch() { return batch_; }

  /// An env number, and a list of them, from Python. They raise TypeError for anything but numbers,
  /// also for truth values, as a mask is not a list of 0 and 1, and IndexError for envs that do not
  /// exist.
  [[nodiscard]] std::uint32_t envNumber(const py::handle& env) const;
  [[nodiscard]] std::vector<std::uint32_t> envNumbers(const py::object& envs) const;
  /// The same for the envs into which saved ones go; None becomes BatchSimulator::kNoEnv.
  [[nodiscard]] std::vector<std::uint32_t> placesOf(const py::object& envs) const;
  /// envNumbers(), or the numbers of all envs for None.
  [[nodiscard]] std::vector<std::uint32_t> allOrThose(const py::object& envs) const;

  /// Throws unless `number` is that of an episode that can start, or from `least` to -1: see
  /// reset().
  void requireEpisode(std::int64_t number, std::int32_t least = 0) const;

  /// The largest number of objects that an env can have.
  [[nodiscard]] std::size_t mostObjects() const {
    return batch_.options().task.distractors ? world_->mostObjects() : 1;
  }

  /// The number of envs, for shapes.
  [[nodiscard]] py::ssize_t envs() const { return static_cast<py::ssize_t>(batch_.envCount()); }

 private:
  /// The input of a step, which must not change during the step.
  struct StepInput {
    InputArray<float> actions;
    InputArray<std::int32_t> resets;

    [[nodiscard]] std::span<const float> actionSpan() const;
    [[nodiscard]] std::span<const std::int32_t> resetSpan() const;
  };

  using EpisodeNumbers = InputArray<std::int32_t>;

  Simulator(std::shared_ptr<const World> world, BatchSimulator batch);
  /// The number that `given` has for each env: an episode that can start, or a special number from
  /// `least` to -1.
  [[nodiscard]] EpisodeNumbers episodeNumbers(const py::object& given, const char* name,
                                              std::int32_t least) const;
  [[nodiscard]] StepInput inputOfStep(const py::object& actions, const py::object& resets) const;

  std::shared_ptr<const World> world_;
  Confinement confinement_{"Simulator"};
  /// The input of the current step. Declared before the batch, whose threads may read it until the
  /// batch is destroyed.
  StepInput input_;
  BatchSimulator batch_;
};

}  // namespace galactic::python
