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

/// What a caller gives as `simulator`. TypeError when it is none, such as a VectorEnv.
[[nodiscard]] Simulator& simulatorOf(const py::object& given);

/// galactic.Simulator: a BatchSimulator that keeps its world, is used by one thread at a time, and
/// knows whether a step is under way. Every member needs the interpreter's lock; the long ones give
/// it away while they work.
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
  /// `episodes`: see BatchSimulator::reset; all are looked at before anything is done. IndexError
  /// for numbers that are none, ValueError for those of episodes that are skipped.
  void reset(const py::object& episodes, bool are_drawn);
  /// Raises what reset() would, and does nothing.
  void checkEpisodes(const py::object& episodes) const;
  void restart(const py::object& seed);
  /// `envs`: None for all, or numbers of envs.
  [[nodiscard]] py::bytes saveState(const py::object& envs);
  void restoreState(const py::object& state, const py::object& envs);

  /// A use of what is there between two steps: RuntimeError while a step is under way.
  [[nodiscard]] Confinement::Use readState();

  [[nodiscard]] const World& world() const { return *world_; }
  [[nodiscard]] const BatchSimulator& batch() const { return batch_; }
  [[nodiscard]] BatchSimulator& batch() { return batch_; }

  /// What the number of an env means, and a list of numbers. TypeError for what is no number, also
  /// for truth values: a mask is no list of 0 and 1. IndexError for those that are not there.
  [[nodiscard]] std::uint32_t envNumber(const py::handle& env) const;
  [[nodiscard]] std::vector<std::uint32_t> envNumbers(const py::object& envs) const;
  /// The same of where saved envs go, BatchSimulator::kNoEnv where that is None.
  [[nodiscard]] std::vector<std::uint32_t> placesOf(const py::object& envs) const;
  /// The same, or the numbers of all envs for None.
  [[nodiscard]] std::vector<std::uint32_t> allOrThose(const py::object& envs) const;

  /// Throws for what is no number of an episode that can be started: see reset().
  void requireEpisode(std::int64_t number, std::int32_t least = 0) const;

  /// The most objects that an env can have.
  [[nodiscard]] std::size_t mostObjects() const {
    return batch_.options().task.distractors ? world_->mostObjects() : 1;
  }

  /// For shapes.
  [[nodiscard]] py::ssize_t envs() const { return static_cast<py::ssize_t>(batch_.envCount()); }

 private:
  /// What a step reads, which has to stay as it is while the step is under way.
  struct StepInput {
    InputArray<float> actions;
    InputArray<std::int32_t> resets;

    [[nodiscard]] std::span<const float> actionSpan() const;
    [[nodiscard]] std::span<const std::int32_t> resetSpan() const;
  };

  using EpisodeNumbers = InputArray<std::int32_t>;

  Simulator(std::shared_ptr<const World> world, BatchSimulator batch);
  /// What `given` says of each env: an episode that can be started, or one of the numbers that mean
  /// something else, which are `least` to -1.
  [[nodiscard]] EpisodeNumbers episodeNumbers(const py::object& given, const char* name,
                                              std::int32_t least) const;
  [[nodiscard]] StepInput inputOfStep(const py::object& actions, const py::object& resets) const;

  std::shared_ptr<const World> world_;
  Confinement confinement_{"Simulator"};
  /// Of the step under way, which reads it until the batch is gone: so before the batch.
  StepInput input_;
  BatchSimulator batch_;
};

}  // namespace galactic::python
