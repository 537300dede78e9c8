#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "arrays.h"
#include "bindings.h"
#include "env_states.h"
#include "filled.h"
#include "galactic/batch_simulator.h"
#include "options.h"
#include "simulator.h"

namespace galactic::python {
namespace {

using Self = const py::object&;

Simulator& of(Self self) { return self.cast<Simulator&>(); }

/// A view of one value per env.
template <class T>
py::array perEnv(Self self, std::span<const T> values, const py::dtype& type = py::dtype::of<T>()) {
  return viewOf(values, {of(self).envs()}, self, type);
}

py::array rowsOf(Self self, std::span<const float> values) {
  const Simulator& simulator = of(self);
  return viewOf(values,
                {simulator.envs(), static_cast<py::ssize_t>(simulator.batch().observationSize())},
                self);
}

py::dict observationParts(const Simulator& simulator) {
  py::dict parts;
  for (const ObservationPart& part : simulator.batch().observationParts()) {
    parts[part.name.c_str()] = py::slice(static_cast<py::ssize_t>(part.first),
                                         static_cast<py::ssize_t>(part.first + part.size), 1);
  }
  return parts;
}

py::dict statistics(Simulator& simulator, const py::object& env) {
  const Confinement::Use use = simulator.readState();
  const BatchSimulator& batch = simulator.batch();
  const SimulationStatistics sum =
      env.is_none() ? batch.statistics() : batch.statistics(simulator.envNumber(env));
  py::dict figures;
  visitStatistics([&](const char* name, auto member) { figures[name] = sum.*member; });
  return figures;
}

/// The statistics of each env, as columns.
py::dict counts(Simulator& simulator, const py::object& envs) {
  const Confinement::Use use = simulator.readState();
  const std::vector<std::uint32_t> chosen = simulator.allOrThose(envs);
  std::vector<SimulationStatistics> each;
  each.reserve(chosen.size());
  for (const std::uint32_t env : chosen) each.push_back(simulator.batch().statistics(env));
  py::dict columns;
  visitStatistics([&]<class T>(const char* name, T SimulationStatistics::*member) {
    using Number = std::conditional_t<std::is_integral_v<T>, std::int64_t, T>;
    Filled<Number> column({static_cast<py::ssize_t>(each.size())});
    for (const SimulationStatistics& of_env : each) {
      column.put(static_cast<Number>(of_env.*member));
    }
    columns[name] = column.array();
  });
  return columns;
}

py::dict episodeNoise(Simulator& simulator, const py::object& envs) {
  const Confinement::Use use = simulator.readState();
  const std::vector<std::uint32_t> chosen = simulator.allOrThose(envs);
  const Shape each{static_cast<py::ssize_t>(chosen.size())};
  Filled<float> motion(each), motion_bias(each), localization(each), laser(each);
  Filled<std::uint32_t> delay(each);
  for (const std::uint32_t env : chosen) {
    const EpisodeNoise noise = simulator.batch().episodeNoise(env);
    motion.put(noise.motion);
    motion_bias.put(noise.motion_bias);
    localization.put(noise.localization);
    delay.put(noise.action_delay);
    laser.put(noise.laser);
  }
  using namespace py::literals;
  return py::dict("motion_noise"_a = motion.array(), "motion_bias"_a = motion_bias.array(),
                  "localization_noise"_a = localization.array(), "action_delay"_a = delay.array(),
                  "laser_noise"_a = laser.array());
}

py::array_t<float> actionsUnderWay(Simulator& simulator, const py::object& env) {
  const Confinement::Use use = simulator.readState();
  const std::vector<float> actions = simulator.batch().actionsUnderWay(simulator.envNumber(env));
  const std::size_t count = simulator.batch().actionCount();
  Filled<float> rows(
      {static_cast<py::ssize_t>(actions.size() / count), static_cast<py::ssize_t>(count)});
  for (const float action : actions) rows.put(action);
  return rows.array();
}

py::dict phaseTimes(Simulator& simulator) {
  const Confinement::Use use = simulator.readState();
  py::dict times;
  for (const PhaseTime& phase : simulator.batch().phaseTimes()) {
    times[py::str(phase.name)] = phase.seconds;
  }
  return times;
}

py::array_t<std::int32_t> episodes(Simulator& simulator, const py::object& envs) {
  const Confinement::Use use = simulator.readState();
  const std::vector<std::uint32_t> chosen = simulator.allOrThose(envs);
  py::array_t<std::int32_t> numbers(static_cast<py::ssize_t>(chosen.size()));
  for (std::size_t n = 0; n < chosen.size(); ++n) {
    const EnvObjects objects = simulator.batch().envObjects(chosen[n]);
    numbers.mutable_data()[n] = static_cast<std::int32_t>(objects.episode);
  }
  return numbers;
}

void bindStepping(py::class_<Simulator>& type) {
  type.def("step", &Simulator::step, py::arg("actions"), py::arg("resets") = py::none(),
           "One step of all envs.\n\n"
           "actions: (num_envs, action_count), float32 without a copy; clamped to [-1, 1], NaN\n"
           "counts as 0. resets: int32 (num_envs,), for each env the index of an episode that\n"
           "begins instead of this step's end, STAYS (-1) for none. Indices as in reset().");
  type.def("begin_step", &Simulator::beginStep, py::arg("actions"), py::arg("resets") = py::none(),
           "The first half of step(): the simulator's threads work, the caller goes on.\n\n"
           "Do not write to actions and resets, nor read what the simulator shows, before\n"
           "end_step() returns.");
  type.def("end_step", &Simulator::endStep, "The second half: helps, and waits for the end.");
  type.def(
      "reset", &Simulator::reset, py::arg("episodes") = py::none(), py::kw_only(),
      py::arg("drawn") = false,
      "Begins episodes between two steps. A new simulator is at the start of the first ones.\n\n"
      "episodes: int32 (num_envs,), for each env the index of an episode, NEXT_EPISODE for the\n"
      "one whose turn it is, or STAYS; None: the next one in every env. Nothing begins if one is\n"
      "wrong: IndexError for those that the world does not have, ValueError for\n"
      "skipped_episodes. drawn: whether chance has chosen these episodes, as the draws of a task\n"
      "do, and not somebody who compares policies by them: their noise of motion and\n"
      "localization is then the env's, another one each time, and not the episode's.");
  type.def("check_episodes", &Simulator::checkEpisodes, py::arg("episodes"),
           "Raises what reset() would raise for these episodes, and does nothing else.");
  type.def("restart", &Simulator::restart, py::arg("seed"),
           "All envs stand at the start of their first episode, as if just made with this seed.");
  type.def(
      "set_states", &setStates, py::arg("states"), py::arg("envs") = py::none(), py::kw_only(),
      py::arg("drawn") = true,
      "Envs go on from states: EnvStates of all of them, or of those with the numbers `envs`, in\n"
      "that order, as env_states() returns them, changed or not, also of another Simulator.\n\n"
      "Each env is in states.episode, whose objects and target are there, after states.step\n"
      "steps of it, with robot, objects and goal where the state says. The base goes to the\n"
      "floor, which may be floor_rise above it at most and floor_drop below (options; 0.05 m\n"
      "each), with the yaw of the root's rotation alone, and joints into their\n"
      "limits. What is held is in the hand as world_from_grip and its pose in objects say, and\n"
      "follows joints that you change; EnvStates.hold() puts an object there. Objects that rest\n"
      "are taken as they are: neither laid down, nor looked at for what they are in. scene\n"
      "and object_kinds play no part. drawn: the luck of an env (noise) is its own; False: that\n"
      "of the episode, as in reset(). What the last step returned stays, but for observations.\n\n"
      "bool (n,): where an env has its state; elsewhere it is as it was, as no floor carries the\n"
      "base, as the robot would penetrate the scene or an object out of the hand's reach, or as\n"
      "the hand does not touch what it is to hold: the box of that is further from the grasp\n"
      "point than the hand's sphere reaches. Nothing changes if one is wrong: IndexError and\n"
      "ValueError for episodes as in reset(), Error for numbers that are not finite, a root that\n"
      "is tilted by more than 0.1 rad, another target than the episode's, an env that is named\n"
      "twice or, where ways along the floor are observed or rewarded (geodesic), another goal.");
  type.def("check_states", &checkStates, py::arg("states"),
           "Raises what set_states() would raise because of these states, and does nothing else.");
  type.def("save_state", &Simulator::saveState, py::arg("envs") = py::none(),
           "The state of all envs as bytes, or of those with the numbers `envs`, in that order:\n"
           "with what the last step returned, the statistics and the seed. A mask is no list of\n"
           "numbers: numpy.flatnonzero(mask) is.");
  type.def(
      "restore_state", &Simulator::restoreState, py::arg("state"), py::arg("envs") = py::none(),
      "Goes on from a state that a simulator of the same world and options saved, bit for bit\n"
      "as that one would have (auto_reset and body_transforms may differ). Into all envs, with\n"
      "the state's seed; or into those with the numbers `envs`, whose random numbers and\n"
      "episodes to come stay their own, of a state of the same seed. A state of one env goes into\n"
      "each of them, to try many plans; of several, each goes into the env that stands in its\n"
      "place, and nowhere where that is None. With a state of many envs, each saved as often as\n"
      "it is wanted, envs go on where others are: restore_state(save_state(envs=parents),\n"
      "envs=range(n)).\n"
      "Error for bytes that are no such state, where an env is named twice, and where one waits\n"
      "for its next episode and none does here; nothing changes then.");
}

void bindResults(py::class_<Simulator>& type) {
  type.def_property_readonly(
      "observations", [](Self self) { return rowsOf(self, of(self).batch().observations()); },
      "After the last step: float32 (num_envs, observation_size), a view. Where an episode ended,\n"
      "the first row of the next.");
  type.def_property_readonly(
      "final_observations",
      [](Self self) { return rowsOf(self, of(self).batch().finalObservations()); },
      "Where an episode ended in the last step, its last row: float32 (num_envs,\n"
      "observation_size), a view; other rows mean nothing.");
  type.def_property_readonly(
      "rewards", [](Self self) { return perEnv(self, of(self).batch().rewards()); },
      "Of the last step: float32 (num_envs,), a view.");
  type.def_property_readonly(
      "dones",
      [](Self self) { return perEnv(self, of(self).batch().dones(), py::dtype::of<bool>()); },
      "Where an episode ended in the last step: bool (num_envs,), a view.");
  type.def_property_readonly(
      "successes",
      [](Self self) { return perEnv(self, of(self).batch().successes(), py::dtype::of<bool>()); },
      "Where it ended in success: bool (num_envs,), a view.");
  type.def_property_readonly(
      "endings",
      [](Self self) {
        return perEnv(self, of(self).batch().endings(), py::dtype::of<std::uint8_t>());
      },
      "How it ended, as numbers of EpisodeEnd: uint8 (num_envs,), a view.");
  type.def_property_readonly(
      "picks",
      [](Self self) { return perEnv(self, of(self).batch().picks(), py::dtype::of<bool>()); },
      "Where it ended and the target had been in the hand at any time of it: bool (num_envs,), a\n"
      "view.");
  type.def_property_readonly(
      "idle",
      [](Self self) { return perEnv(self, of(self).batch().idle(), py::dtype::of<bool>()); },
      "Where an env has had its share of the episodes (order='partition'), or waits where its\n"
      "episode ended (auto_reset=False): it stays as it is, and nothing of it counts, until\n"
      "reset() begins an episode. bool (num_envs,), a view.");
}

void bindQueries(py::class_<Simulator>& type) {
  type.def_property_readonly(
      "num_envs", [](const Simulator& one) { return one.batch().envCount(); }, "How many envs.");
  type.def_property_readonly(
      "action_count", [](const Simulator& one) { return one.batch().actionCount(); },
      "Columns of the actions; World.actions says what they do.");
  type.def_property_readonly(
      "observation_size", [](const Simulator& one) { return one.batch().observationSize(); },
      "Columns of the observations; observation_parts says what they are.");
  type.def_property_readonly("observation_parts", &observationParts,
                             "The parts of a row of the observations: name to slice, in order.");
  type.def_property_readonly(
      "thread_count", [](const Simulator& one) { return one.batch().threadCount(); },
      "How many threads step.");
  type.def_property_readonly(
      "options",
      [](const Simulator& one) {
        const SimulationOptions& options = one.batch().options();
        py::dict keywords;
        keywords["auto_reset"] = options.auto_reset;
        keywords["body_transforms"] = options.body_transforms;
        keywords.attr("update")(keywordsOf(options));
        return keywords;
      },
      "All options in force but the number of threads, as keywords of Simulator.");
  type.def_static(
      "check_options", [](const py::kwargs& options) { (void)taskTextsOf(options); },
      "Raises what a Simulator would for options that are wrong in any world: TypeError for an\n"
      "unknown one, with the nearest name, and galactic.Error for a wrong value.");
  type.def_property_readonly(
      "skipped_episodes",
      [](const Simulator& one) {
        const std::span<const std::uint32_t> skipped = one.batch().skippedEpisodes();
        return std::vector<std::uint32_t>(skipped.begin(), skipped.end());
      },
      "Indices of the episodes in which the robot cannot start.");
  type.def_property_readonly(
      "memory_bytes", [](const Simulator& one) { return one.batch().memoryBytes(); },
      "Memory of all envs together.");
  type.def_property_readonly(
      "shared_bytes", [](const Simulator& one) { return one.batch().sharedBytes(); },
      "Memory of what all envs share beside the packs: how episodes begin, what is known of the\n"
      "floors of all homes, ways along them, and what lasers see.");
  type.def("episodes", &episodes, py::arg("envs") = py::none(),
           "The index of the episode that each env is in, or each of the numbers `envs`: int32,\n"
           "a copy.");
  type.def("env_state", &envState, py::arg("env"), "The state of one env, as a copy.");
  type.def("env_states", &envStates, py::arg("envs") = py::none(),
           "The states of all envs in arrays, or of those with the numbers `envs`: EnvStates, a\n"
           "copy.");
  type.def("statistics", &statistics, py::arg("env") = py::none(),
           "What happened in all envs since they were made, added up; or in one of them.");
  type.def("counts", &counts, py::arg("envs") = py::none(),
           "The same of each env, or of each of the numbers `envs`, in arrays (n,): copies. What\n"
           "changes from one step to the next is what happened in it.");
  type.def("episode_noise", &episodeNoise, py::arg("envs") = py::none(),
           "The noise that the episode of each env, or of each of the numbers `envs`, has drawn\n"
           "where options give ranges: motion_noise, motion_bias, localization_noise,\n"
           "action_delay (uint32, others float32) and laser_noise, (n,), copies.");
  type.def("actions_under_way", &actionsUnderWay, py::arg("env"),
           "What an env was asked to do and has not done yet, as actions arrive late: float32\n"
           "(action_delay of its episode, action_count), a copy, the action first that is due in\n"
           "the next step. Of steps before the episode, nothing moves, and what is asked of hand\n"
           "and terminate is NaN.");
  type.def(
      "sample_phases",
      [](Simulator& one, const py::object& every) {
        const auto steps = wholeOf("every", every, 0, std::numeric_limits<std::uint32_t>::max());
        const Confinement::Use use = one.readState();
        one.batch().samplePhases(static_cast<std::uint32_t>(steps));
      },
      py::arg("every"), "Measures one step in `every` from now on; 0 switches it off.");
  type.def("phase_times", &phaseTimes,
           "Seconds that the threads spent in each phase of the measured steps, added up.");
}

/// What Python calls each end, and its number.
std::vector<std::pair<std::string, int>> episodeEnds() {
  std::vector<std::pair<std::string, int>> ends;
  for (std::size_t n = 0; n < kEpisodeEnds; ++n) {
    std::string name(nameOf(static_cast<EpisodeEnd>(n)));
    for (char& letter : name) {
      letter = letter == ' ' ? '_' : static_cast<char>(letter - 'a' + 'A');
    }
    ends.emplace_back(std::move(name), static_cast<int>(n));
  }
  // Of tasks that are written in Python, of which the library knows nothing. Demonstrations keep
  // the number: the last one that fits, which no end of the library will need.
  constexpr int kFailure = 255;
  static_assert(kEpisodeEnds <= kFailure);
  ends.emplace_back("FAILURE", kFailure);
  return ends;
}

}  // namespace

void bindSimulator(py::module_& module) {
  bindEnum(
      module, "EpisodeEnd", episodeEnds(),
      "How an episode ended. TIME_OUT is a truncation, all others behind NONE are terminations; "
      "FAILURE is what a galactic.Task calls one, and no Simulator says it.");
  py::class_<Simulator> type(module, "Simulator");
  type.def(
      py::init([](const py::object& world, const py::object& envs, const py::kwargs& options) {
        if (!py::isinstance<World>(world)) {
          throw py::type_error(
              fmt::format("world is a {}, expected a galactic.World", typeName(world)));
        }
        // A blank one is refused by its reference alone, not by its pointer.
        (void)world.cast<const World&>();
        if (!envs.is_none()) options["envs"] = envs;
        return Simulator::create(world.cast<std::shared_ptr<World>>(), options);
      }),
      py::arg("world"), py::arg("envs") = py::none(),
      "Makes envs, each at the start of its first episode.\n\n"
      "Keywords: every option of galactic-run's simulation with '_' for '-' (envs=128, seed=1,\n"
      "order='shuffled', task='pick', no_distractors=True, ...; docs/tools.md has them),\n"
      "threads=0 (one per processor), body_transforms=False (rendering needs them) and\n"
      "auto_reset=True (False: envs whose episode ended are idle until reset()). Options of the\n"
      "world's task apply where no keyword says otherwise.");
  type.doc() =
      "N environments of one world, stepped together.\n\n"
      "Arrays that it shows are views: no copy, read-only, valid as long as they are kept\n"
      "(they keep the simulator), with new contents after each step. One thread at a time.";
  type.attr("STAYS") = BatchSimulator::kStays;
  type.attr("NEXT_EPISODE") = BatchSimulator::kNextEpisode;
  type.attr("NOISE_OPTIONS") = py::tuple(py::cast(robotNoiseKeywords()));
  bindStepping(type);
  bindResults(type);
  bindQueries(type);
  type.def("__repr__", [](const Simulator& one) {
    return fmt::format("<galactic.Simulator of {} envs, {} threads>", one.batch().envCount(),
                       one.batch().threadCount());
  });
  type.attr("__module__") = "galactic";
  refusePickling(type,
                 "make it again from its world in each process, and carry its state over with "
                 "save_state() and restore_state()");
}

}  // namespace galactic::python
