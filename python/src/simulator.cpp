#include "simulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "galactic/error.h"
#include "options.h"

namespace galactic::python {
namespace {

void requireNumbers(const py::object& envs) {
  if (py::isinstance<py::iterable>(envs)) return;
  throw py::type_error(
      fmt::format("envs is a {}, expected numbers of envs, such as [0, 3]", typeName(envs)));
}

}  // namespace

Simulator& simulatorOf(const py::object& given) {
  if (py::isinstance<Simulator>(given)) return given.cast<Simulator&>();
  throw py::type_error(fmt::format(
      "simulator is a {}, expected a galactic.Simulator; VectorEnv.simulators has those of one",
      typeName(given)));
}

std::span<const float> Simulator::StepInput::actionSpan() const {
  return {actions.data(), static_cast<std::size_t>(actions.size())};
}

std::span<const std::int32_t> Simulator::StepInput::resetSpan() const {
  return {resets.data(), static_cast<std::size_t>(resets.size())};
}

Simulator::Simulator(std::shared_ptr<const World> world, BatchSimulator batch)
    : world_(std::move(world)), batch_(std::move(batch)) {}

std::unique_ptr<Simulator> Simulator::create(std::shared_ptr<const World> world,
                                             const py::dict& keywords) {
  const SimulationOptions options = optionsOf(*world, keywords);
  BatchSimulator batch = [&] {
    const py::gil_scoped_release unlocked;
    return orThrow(BatchSimulator::create(*world, options));
  }();
  return std::unique_ptr<Simulator>(new Simulator(std::move(world), std::move(batch)));
}

Simulator::StepInput Simulator::inputOfStep(const py::object& actions,
                                            const py::object& resets) const {
  StepInput input;
  input.actions =
      inputOf<float>(actions, "actions", {envs(), static_cast<py::ssize_t>(batch_.actionCount())});
  if (!resets.is_none()) {
    input.resets = episodeNumbers(resets, "resets", BatchSimulator::kStays);
  }
  return input;
}

Confinement::Use Simulator::readState() {
  Confinement::Use use = confinement_.enter();
  if (batch_.isStepping()) throw std::runtime_error("a step is under way; call end_step() first");
  return use;
}

void Simulator::step(const py::object& actions, const py::object& resets) {
  const StepInput input = inputOfStep(actions, resets);
  const Confinement::Use use = readState();
  const py::gil_scoped_release unlocked;
  batch_.step(input.actionSpan(), input.resetSpan());
}

void Simulator::beginStep(const py::object& actions, const py::object& resets) {
  StepInput input = inputOfStep(actions, resets);
  const Confinement::Use use = readState();
  input_ = std::move(input);
  batch_.beginStep(input_.actionSpan(), input_.resetSpan());
}

void Simulator::endStep() {
  const Confinement::Use use = confinement_.enter();
  if (!batch_.isStepping()) {
    throw std::runtime_error("no step is under way; call begin_step() first");
  }
  {
    const py::gil_scoped_release unlocked;
    batch_.endStep();
  }
  input_ = {};
}

void Simulator::reset(const py::object& episodes, bool are_drawn) {
  EpisodeNumbers chosen(envs());
  if (episodes.is_none()) {
    std::fill_n(chosen.mutable_data(), chosen.size(), BatchSimulator::kNextEpisode);
  } else {
    chosen = episodeNumbers(episodes, "episodes", BatchSimulator::kNextEpisode);
  }
  const Confinement::Use use = readState();
  const std::span<const std::int32_t> values{chosen.data(),
                                             static_cast<std::size_t>(chosen.size())};
  const py::gil_scoped_release unlocked;
  batch_.reset(values, are_drawn ? EpisodeChoice::kDrawn : EpisodeChoice::kNamed);
}

void Simulator::checkEpisodes(const py::object& episodes) const {
  (void)episodeNumbers(episodes, "episodes", BatchSimulator::kNextEpisode);
}

Simulator::EpisodeNumbers Simulator::episodeNumbers(const py::object& given, const char* name,
                                                    std::int32_t least) const {
  // Read 64 bits first, so that a number that is too large does not wrap around.
  const auto numbers = wholeNumbersOf(given, name, {envs()});
  EpisodeNumbers narrow(envs());
  std::int32_t* to = narrow.mutable_data();
  for (const std::int64_t number : std::span(numbers.data(), batch_.envCount())) {
    if (number == BatchSimulator::kNextEpisode && number < least) {
      throw py::index_error(fmt::format(
          "{} has NEXT_EPISODE, which is for reset(); expected the index of an episode, or STAYS",
          name));
    }
    requireEpisode(number, least);
    *to++ = static_cast<std::int32_t>(number);
  }
  return narrow;
}

void Simulator::requireEpisode(std::int64_t number, std::int32_t least) const {
  const std::size_t count = world_->episodes().episodes().size();
  if (number < least || number >= static_cast<std::int64_t>(count)) {
    throw py::index_error(
        fmt::format("there is no episode {}; the world's last is {}", number, count - 1));
  }
  const std::span<const std::uint32_t> skipped = batch_.skippedEpisodes();
  if (number >= 0 && std::ranges::binary_search(skipped, static_cast<std::uint32_t>(number))) {
    throw py::value_error(
        fmt::format("the robot cannot start in episode {}; skipped_episodes lists all such, leave "
                    "them out",
                    number));
  }
}

void Simulator::restart(const py::object& seed) {
  const std::uint64_t number = wholeOf("seed", seed, 0, std::numeric_limits<std::uint64_t>::max());
  const Confinement::Use use = readState();
  const py::gil_scoped_release unlocked;
  batch_.restart(number);
}

std::uint32_t Simulator::envNumber(const py::handle& env) const {
  if (isTruth(env) || PyIndex_Check(env.ptr()) == 0) {
    throw py::type_error(
        fmt::format("an env is a {}, expected its number; numpy.flatnonzero(mask) has the numbers "
                    "of a mask",
                    typeName(env)));
  }
  int is_too_large = 0;
  const auto number = py::reinterpret_steal<py::object>(PyNumber_Index(env.ptr()));
  if (!number) throw py::error_already_set();
  const std::int64_t found = PyLong_AsLongLongAndOverflow(number.ptr(), &is_too_large);
  if (is_too_large != 0 || found < 0 || found >= envs()) {
    throw py::index_error(fmt::format("there is no env {}, the last is {}",
                                      py::str(number).cast<std::string>(), envs() - 1));
  }
  return static_cast<std::uint32_t>(found);
}

std::vector<std::uint32_t> Simulator::envNumbers(const py::object& envs) const {
  requireNumbers(envs);
  std::vector<std::uint32_t> numbers;
  for (const py::handle one : envs) numbers.push_back(envNumber(one));
  return numbers;
}

std::vector<std::uint32_t> Simulator::placesOf(const py::object& envs) const {
  requireNumbers(envs);
  std::vector<std::uint32_t> places;
  for (const py::handle one : envs) {
    places.push_back(one.is_none() ? BatchSimulator::kNoEnv : envNumber(one));
  }
  return places;
}

std::vector<std::uint32_t> Simulator::allOrThose(const py::object& envs) const {
  if (!envs.is_none()) return envNumbers(envs);
  std::vector<std::uint32_t> numbers(batch_.envCount());
  std::iota(numbers.begin(), numbers.end(), 0U);
  return numbers;
}

py::bytes Simulator::saveState(const py::object& envs) {
  const Confinement::Use use = readState();
  const std::vector<std::byte> state =
      envs.is_none() ? batch_.saveState() : batch_.saveState(envNumbers(envs));
  return {reinterpret_cast<const char*>(state.data()), state.size()};
}

void Simulator::restoreState(const py::object& state, const py::object& envs) {
  const InputBytes input(state);
  const Confinement::Use use = readState();
  orThrow(envs.is_none() ? batch_.restoreState(input.bytes())
                         : batch_.restoreState(input.bytes(), placesOf(envs)));
}

}  // namespace galactic::python
