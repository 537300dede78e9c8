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
           "actions: (num_envs, action_count), not copied if float32; clamped to [-1, 1], NaN\n"
           "counts as 0. resets: int32 (num_envs,), for each env the index of an episode that\n"
           "begins at the end of this step, or STAYS (-1) for none. Indices as in reset().");
  type.def("begin_step", &Simulator::beginStep, py::arg("actions"), py::arg("resets") = py::none(),
           "The first half of step(): the simulator's threads begin to work, and the call\n"
           "returns.\n\n"
           "Before end_step() returns, do not write to actions and resets, and do not read the\n"
           "simulator's arrays.");
  type.def("end_step", &Simulator::endStep,
           "The second half of step(): helps the threads, and waits for its end.");
  type.def(
      "reset", &Simulator::reset, py::arg("episodes") = py::none(), py::kw_only(),
      py::arg("drawn") = false,
      "Begins episodes between two steps. In a new simulator, the first ones have begun.\n\n"
      "episodes: int32 (num_envs,), for each env the index of an episode, NEXT_EPISODE for the\n"
      "env's next one in order, or STAYS; None: the next one in every env. Nothing begins if\n"
      "one is wrong: IndexError for episodes that the world does not have, ValueError for\n"
      "skipped_episodes. drawn: True if the episodes were chosen at random, as by the draws of\n"
      "a task; then the noise of motion and localization belongs to the env, and differs each\n"
      "time. False if they were chosen to compare policies; then the noise belongs to the\n"
      "episode.");
  type.def("check_episodes", &Simulator::checkEpisodes, py::arg("episodes"),
           "Raises what reset() would raise for these episodes, and does nothing else.");
  type.def("restart", &Simulator::restart, py::arg("seed"),
           "Puts all envs at the start of their first episode, as if just made with this seed.");
  type.def(
      "set_states", &setStates, py::arg("states"), py::arg("envs") = py::none(), py::kw_only(),
      py::arg("drawn") = true,
      "Sets envs to states: EnvStates for all envs, or for those with the numbers `envs`, in\n"
      "that order, as env_states() returns them. They may be changed, and may come from another\n"
      "Simulator.\n\n"
      "Each env is then in states.episode, with its objects and target, after states.step\n"
      "steps, with robot, objects and goal as in the state. The base is put on the floor, which\n"
      "may be up to floor_rise above it or floor_drop below it (options; 0.05 m each), with\n"
      "only the yaw of the root's rotation; joints are clamped to their limits. A held object\n"
      "is in the hand as given by world_from_grip and its pose in objects, and moves with\n"
      "joints that you change; EnvStates.hold() puts an object there. Resting objects stay\n"
      "where the state puts them: they neither fall, nor are checked for penetration. scene and\n"
      "object_kinds are ignored. drawn: whether noise belongs to the env; False: to the\n"
      "episode, as in reset(). Results of the last step stay as they are, except observations.\n\n"
      "Returns bool (n,): which envs have their state. The others are unchanged, because no\n"
      "floor carries the base, because the robot would penetrate the scene or an object out of\n"
      "the hand's reach, or because the hand does not touch the object that it is to hold: the\n"
      "object's box is further from the grasp point than the radius of the hand's sphere.\n"
      "Nothing changes if a state is invalid: IndexError and ValueError for episodes as in\n"
      "reset(); Error for numbers that are not finite, a root that is tilted by more than 0.1\n"
      "rad, another target than the episode's, an env that is named twice or, if paths along\n"
      "the floor are observed or rewarded (geodesic), another goal.");
  type.def("check_states", &checkStates, py::arg("states"),
           "Raises what set_states() would raise for these states, and does nothing else.");
  type.def("save_state", &Simulator::saveState, py::arg("envs") = py::none(),
           "The state of all envs as bytes, or of those with the numbers `envs`, in that order,\n"
           "including the results of the last step, the statistics and the seed. To select envs\n"
           "by a mask, pass numpy.flatnonzero(mask).");
  type.def(
      "restore_state", &Simulator::restoreState, py::arg("state"), py::arg("envs") = py::none(),
      "Restores a state saved by a simulator of the same world and options (auto_reset and\n"
      "body_transforms may differ); envs continue from it bit for bit. Without `envs`, restores\n"
      "all envs and the seed. With `envs`, restores the envs with these numbers, which keep\n"
      "their own random numbers and future episodes; the seeds must be equal. A state of one\n"
      "env is copied into each of them, for example to try many plans; of a state of several\n"
      "envs, each goes into the env at the same place in `envs`, and is dropped if that is\n"
      "None. To copy envs over others, save each as often as you need it:\n"
      "restore_state(save_state(envs=parents), envs=range(n)). Raises Error, and changes\n"
      "nothing, if the bytes are not such a state, if an env is named twice, or if a saved env\n"
      "waits for its next episode and none does in this simulator.");
}

void bindResults(py::class_<Simulator>& type) {
  type.def_property_readonly(
      "observations", [](Self self) { return rowsOf(self, of(self).batch().observations()); },
      "Observations after the last step: float32 (num_envs, observation_size), a view. Where an\n"
      "episode ended, the first row of the next one.");
  type.def_property_readonly(
      "final_observations",
      [](Self self) { return rowsOf(self, of(self).batch().finalObservations()); },
      "The last observation of each episode that ended in the last step: float32 (num_envs,\n"
      "observation_size), a view; other rows are undefined.");
  type.def_property_readonly(
      "rewards", [](Self self) { return perEnv(self, of(self).batch().rewards()); },
      "Rewards of the last step: float32 (num_envs,), a view.");
  type.def_property_readonly(
      "dones",
      [](Self self) { return perEnv(self, of(self).batch().dones(), py::dtype::of<bool>()); },
      "Whether an episode ended in the last step: bool (num_envs,), a view.");
  type.def_property_readonly(
      "successes",
      [](Self self) { return perEnv(self, of(self).batch().successes(), py::dtype::of<bool>()); },
      "Whether it ended in success: bool (num_envs,), a view.");
  type.def_property_readonly(
      "endings",
      [](Self self) {
        return perEnv(self, of(self).batch().endings(), py::dtype::of<std::uint8_t>());
      },
      "How it ended, as values of EpisodeEnd: uint8 (num_envs,), a view.");
  type.def_property_readonly(
      "picks",
      [](Self self) { return perEnv(self, of(self).batch().picks(), py::dtype::of<bool>()); },
      "Whether it ended and the target had been in the hand at some time: bool (num_envs,), a\n"
      "view.");
  type.def_property_readonly(
      "idle",
      [](Self self) { return perEnv(self, of(self).batch().idle(), py::dtype::of<bool>()); },
      "Whether an env has finished its share of the episodes (order='partition'), or waits\n"
      "after the end of its episode (auto_reset=False): it does not change, and its results do\n"
      "not count, until reset() begins an episode. bool (num_envs,), a view.");
}

void bindQueries(py::class_<Simulator>& type) {
  type.def_property_readonly(
      "num_envs", [](const Simulator& one) { return one.batch().envCount(); },
      "The number of envs.");
  type.def_property_readonly(
      "action_count", [](const Simulator& one) { return one.batch().actionCount(); },
      "The number of columns of the actions; World.actions describes them.");
  type.def_property_readonly(
      "observation_size", [](const Simulator& one) { return one.batch().observationSize(); },
      "The number of columns of the observations; observation_parts describes them.");
  type.def_property_readonly("observation_parts", &observationParts,
                             "The parts of a row of the observations: name to slice, in order.");
  type.def_property_readonly(
      "thread_count", [](const Simulator& one) { return one.batch().threadCount(); },
      "The number of threads that step.");
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
      "All options in effect, except the number of threads, as keywords of Simulator.");
  type.def_static(
      "check_options", [](const py::kwargs& options) { (void)taskTextsOf(options); },
      "Raises what a Simulator would raise for options that are wrong in any world: TypeError\n"
      "for an unknown one, with the nearest name, and galactic.Error for a wrong value.");
  type.def_property_readonly(
      "skipped_episodes",
      [](const Simulator& one) {
        const std::span<const std::uint32_t> skipped = one.batch().skippedEpisodes();
        return std::vector<std::uint32_t>(skipped.begin(), skipped.end());
      },
      "Indices of the episodes in which the robot cannot start.");
  type.def_property_readonly(
      "memory_bytes", [](const Simulator& one) { return one.batch().memoryBytes(); },
      "Memory of all envs together, bytes.");
  type.def_property_readonly(
      "shared_bytes", [](const Simulator& one) { return one.batch().sharedBytes(); },
      "Memory that all envs share besides the packs, bytes: how episodes begin, the floors of\n"
      "all homes, paths along them, and what lasers see.");
  type.def("episodes", &episodes, py::arg("envs") = py::none(),
           "The index of the episode that each env is in, or each of the numbers `envs`: int32,\n"
           "a copy.");
  type.def("env_state", &envState, py::arg("env"), "The state of one env, as a copy.");
  type.def("env_states", &envStates, py::arg("envs") = py::none(),
           "The states of all envs in arrays, or of those with the numbers `envs`: EnvStates, a\n"
           "copy.");
  type.def("statistics", &statistics, py::arg("env") = py::none(),
           "Counts of what happened since the simulator was made, summed over all envs, or in\n"
           "one of them.");
  type.def("counts", &counts, py::arg("envs") = py::none(),
           "The statistics of each env, or of each of the numbers `envs`, in arrays (n,):\n"
           "copies. The difference between two steps is what happened in the second.");
  type.def("episode_noise", &episodeNoise, py::arg("envs") = py::none(),
           "The noise of the episode of each env, or of each of the numbers `envs`, as drawn\n"
           "from the ranges in the options: motion_noise, motion_bias, localization_noise,\n"
           "action_delay (uint32, others float32) and laser_noise, (n,), copies.");
  type.def("actions_under_way", &actionsUnderWay, py::arg("env"),
           "The actions that an env has been given but has not executed yet, as they are\n"
           "delayed: float32 (action_delay of its episode, action_count), a copy, starting with\n"
           "the action due in the next step. Actions for steps before the episode move nothing,\n"
           "and have NaN for hand and terminate.");
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

/// Python's name of each end, and its number.
std::vector<std::pair<std::string, int>> episodeEnds() {
  std::vector<std::pair<std::string, int>> ends;
  for (std::size_t n = 0; n < kEpisodeEnds; ++n) {
    std::string name(nameOf(static_cast<EpisodeEnd>(n)));
    for (char& letter : name) {
      letter = letter == ' ' ? '_' : static_cast<char>(letter - 'a' + 'A');
    }
    ends.emplace_back(std::move(name), static_cast<int>(n));
  }
  // FAILURE is for tasks that are written in Python; the library does not have it. Demonstrations
  // store the number, so it is the last one that fits, which no end of the library will ever need.
  constexpr int kFailure = 255;
  static_assert(kEpisodeEnds <= kFailure);
  ends.emplace_back("FAILURE", kFailure);
  return ends;
}

}  // namespace

void bindSimulator(py::module_& module) {
  bindEnum(
      module, "EpisodeEnd", episodeEnds(),
      "How an episode ended. TIME_OUT is a truncation, all others after NONE are terminations;\n"
      "only a galactic.Task reports FAILURE, never a Simulator.");
  py::class_<Simulator> type(module, "Simulator");
  type.def(
      py::init([](const py::object& world, const py::object& envs, const py::kwargs& options) {
        if (!py::isinstance<World>(world)) {
          throw py::type_error(
              fmt::format("world is a {}, expected a galactic.World", typeName(world)));
        }
        // Casting to a reference rejects a blank object; casting to a pointer does not.
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
      "world's task apply unless a keyword overrides them.");
  type.doc() =
      "N environments of one world, stepped together.\n\n"
      "Its arrays are read-only views without a copy. They keep the simulator alive, and have\n"
      "new contents after each step. Only one thread may use a simulator at a time.";
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
