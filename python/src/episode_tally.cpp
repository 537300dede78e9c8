#include "episode_tally.h"

#include <algorithm>

#include "arrays.h"
#include "bindings.h"

namespace galactic::python {
namespace {

/// An array of one value per env.
template <class T>
py::array_t<T> filled(std::size_t envs, T value) {
  py::array_t<T> values(static_cast<py::ssize_t>(envs));
  std::fill_n(values.mutable_data(), envs, value);
  return values;
}

}  // namespace

EpisodeTally::EpisodeTally(Simulator& simulator)
    : simulator_(simulator),
      returns_(simulator.batch().envCount()),
      lengths_(returns_.size()),
      episodes_(returns_.size()) {
  for (std::size_t env = 0; env < episodes_.size(); ++env) episodes_[env] = episodeOf(env);
}

std::int32_t EpisodeTally::episodeOf(std::size_t env) const {
  return static_cast<std::int32_t>(simulator_.batch().envObjects(env).episode);
}

/// Whether the target was in the hand in the episode that the last step ended. A user-defined task
/// may have ended an episode that goes on in the simulator, whose env is then still in it.
bool EpisodeTally::hadPicked(std::size_t env) const {
  const BatchSimulator& batch = simulator_.batch();
  return batch.dones()[env] != 0 ? batch.picks()[env] != 0 : batch.envObjects(env).has_picked;
}

py::tuple EpisodeTally::add(const py::object& rewards, const py::object& endings) {
  const Confinement::Use use = simulator_.readState();
  const std::size_t envs = returns_.size();
  const auto paid = inputOf<float>(rewards, "rewards", {simulator_.envs()});
  const auto ends = inputOf<std::uint8_t>(endings, "endings", {simulator_.envs()});
  py::array_t<bool> terminations = filled(envs, false);
  py::array_t<bool> truncations = filled(envs, false);
  ended_.clear();
  endings_.clear();
  picked_.clear();
  for (std::size_t env = 0; env < envs; ++env) {
    const std::uint8_t end = ends.data()[env];
    returns_[env] += static_cast<double>(paid.data()[env]);
    ++lengths_[env];
    if (end == static_cast<std::uint8_t>(EpisodeEnd::kNone)) continue;
    (isTruncation(EpisodeEnd{end}) ? truncations : terminations).mutable_data()[env] = true;
    ended_.push_back(env);
    endings_.push_back(end);
    picked_.push_back(hadPicked(env));
  }
  py::array_t<std::int64_t> which(static_cast<py::ssize_t>(ended_.size()));
  std::copy(ended_.begin(), ended_.end(), which.mutable_data());
  return py::make_tuple(terminations, truncations, which);
}

py::dict EpisodeTally::takeEnded() {
  const Confinement::Use use = simulator_.readState();
  const std::size_t envs = returns_.size();
  py::array_t<bool> ended = filled(envs, false);
  py::array_t<float> sums = filled(envs, 0.0F);
  py::array_t<std::int64_t> lengths = filled(envs, std::int64_t{0});
  py::array_t<std::uint8_t> endings = filled(envs, std::uint8_t{0});
  py::array_t<bool> successes = filled(envs, false);
  py::array_t<bool> picked = filled(envs, false);
  py::array_t<std::int32_t> episodes = filled(envs, std::int32_t{-1});
  for (std::size_t n = 0; n < ended_.size(); ++n) {
    const std::size_t env = ended_[n];
    ended.mutable_data()[env] = true;
    sums.mutable_data()[env] = static_cast<float>(returns_[env]);
    lengths.mutable_data()[env] = lengths_[env];
    endings.mutable_data()[env] = endings_[n];
    successes.mutable_data()[env] = endings_[n] == static_cast<std::uint8_t>(EpisodeEnd::kSuccess);
    picked.mutable_data()[env] = picked_[n];
    episodes.mutable_data()[env] = episodes_[env];
    returns_[env] = 0;
    lengths_[env] = 0;
    episodes_[env] = episodeOf(env);
  }
  ended_.clear();
  endings_.clear();
  picked_.clear();
  py::dict result;
  result["ended"] = ended;
  result["r"] = sums;
  result["l"] = lengths;
  result["ending"] = endings;
  result["success"] = successes;
  result["picked"] = picked;
  result["episode_index"] = episodes;
  return result;
}

void EpisodeTally::restart(const py::object& mask) {
  const Confinement::Use use = simulator_.readState();
  const auto chosen = inputOf<bool>(mask, "mask", {simulator_.envs()});
  for (std::size_t env = 0; env < returns_.size(); ++env) {
    episodes_[env] = episodeOf(env);
    if (!chosen.data()[env]) continue;
    returns_[env] = 0;
    lengths_[env] = 0;
  }
}

void EpisodeTally::restore(const py::object& returns, const py::object& lengths) {
  const Confinement::Use use = simulator_.readState();
  const auto sums = inputOf<double>(returns, "returns", {simulator_.envs()});
  const auto steps = inputOf<std::int64_t>(lengths, "lengths", {simulator_.envs()});
  std::copy_n(sums.data(), returns_.size(), returns_.begin());
  std::copy_n(steps.data(), lengths_.size(), lengths_.begin());
  for (std::size_t env = 0; env < episodes_.size(); ++env) episodes_[env] = episodeOf(env);
}

void bindEpisodeTally(py::module_& module) {
  using Self = const py::object&;
  py::class_<EpisodeTally> type(module, "EpisodeTally");
  type.def(py::init<Simulator&>(), py::arg("simulator"), py::keep_alive<1, 2>())
      .def("add", &EpisodeTally::add, py::arg("rewards"), py::arg("endings"),
           "Adds the last step; returns (terminations, truncations, the envs whose episodes\n"
           "ended).")
      .def("take_ended", &EpisodeTally::takeEnded,
           "Describes the episodes that the last added step ended, and resets their sums.")
      .def("restart", &EpisodeTally::restart, py::arg("mask"))
      .def("restore", &EpisodeTally::restore, py::arg("returns"), py::arg("lengths"))
      .def_property_readonly("returns",
                             [](Self self) {
                               const auto& tally = self.cast<const EpisodeTally&>();
                               const auto count = static_cast<py::ssize_t>(tally.returns().size());
                               return viewOf(tally.returns(), {count}, self);
                             })
      .def_property_readonly("lengths", [](Self self) {
        const auto& tally = self.cast<const EpisodeTally&>();
        const auto count = static_cast<py::ssize_t>(tally.lengths().size());
        return viewOf(tally.lengths(), {count}, self);
      });
  type.doc() =
      "Returns and lengths of the current episodes of a Simulator, for vector environments.";
  refusePickling(type, "save and restore the environment instead");
}

}  // namespace galactic::python
