#include "dynamics/report/journal.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "support/try.h"

namespace galactic::dynamics {
namespace {

using Json = nlohmann::json;

template <class T>
Json jsonOf(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json jsonOf(const MissKey& key) {
  const auto& [link, thing, cause] = key;
  return {link, static_cast<int>(thing), static_cast<int>(cause)};
}

MissKey missKeyOf(const Json& json) {
  const auto thing = json.at(1).get<std::size_t>();
  const auto cause = json.at(2).get<std::size_t>();
  if (thing >= kThingNames.size() || cause >= kMissCauseNames.size()) {
    throw std::out_of_range("no such contact");
  }
  return {json.at(0).get<std::uint32_t>(), static_cast<Thing>(thing),
          static_cast<MissCause>(cause)};
}

EpisodeEnd endOf(const Json& json) {
  const auto end = json.get<std::size_t>();
  if (end >= kEpisodeEnds) throw std::out_of_range("no such end");
  return static_cast<EpisodeEnd>(end);
}

Json jsonOf(const Pose& pose) {
  const auto& [t, q] = pose;
  return {t.x, t.y, t.z, q.x, q.y, q.z, q.w};
}

Pose poseOf(const Json& json) {
  const auto n = [&json](std::size_t at) { return json.at(at).get<float>(); };
  return {{n(0), n(1), n(2)}, {n(3), n(4), n(5), n(6)}};
}

Json contactsOf(const EpisodeComparison& c) {
  Json missed = Json::array();
  for (const auto& [key, steps] : c.missed) missed.push_back({jsonOf(key), steps});
  Json invented = Json::array();
  for (const auto& [cause, steps] : c.invented) {
    invented.push_back({static_cast<int>(cause), steps});
  }
  Json deepest = nullptr;
  if (c.deepest) deepest = {c.deepest->step, c.deepest->depth, jsonOf(c.deepest->key)};
  return {missed, c.missed_steps, deepest, c.hindered, invented};
}

Json jsonOf(const EpisodeComparison& c) {
  Json rests = Json::array();
  for (const Rest& rest : c.rests) {
    rests.push_back(
        {rest.displacement, rest.lean, rest.drop, rest.step, jsonOf(rest.world_from_object)});
  }
  return {{"of", {c.env, c.episode}},
          {"simulation", {static_cast<int>(c.end), c.steps}},
          {"dynamics", {static_cast<int>(c.end_in_dynamics), c.steps_in_dynamics}},
          {"settled", c.success_settled},
          {"picked", c.picked_in_dynamics},
          {"parted", jsonOf(c.parted)},
          {"base", c.base_gap},
          {"grip", c.grip_gap},
          {"tracking", {c.tracking_sum, c.tracking_worst}},
          {"contacts", contactsOf(c)},
          {"disturbed", c.disturbed},
          {"rests", rests}};
}

void takeContacts(const Json& json, EpisodeComparison& c) {
  for (const Json& one : json.at(0)) {
    c.missed[missKeyOf(one.at(0))] = one.at(1).get<std::uint32_t>();
  }
  c.missed_steps = json.at(1).get<std::uint32_t>();
  if (const Json& deepest = json.at(2); !deepest.is_null()) {
    c.deepest = DeepContact{.step = deepest.at(0).get<std::uint32_t>(),
                            .depth = deepest.at(1).get<float>(),
                            .key = missKeyOf(deepest.at(2))};
  }
  c.hindered = json.at(3).get<std::uint32_t>();
  for (const Json& one : json.at(4)) {
    const auto cause = one.at(0).get<std::size_t>();
    if (cause >= kInventedCauseNames.size()) throw std::out_of_range("no such cause");
    c.invented[static_cast<InventedCause>(cause)] = one.at(1).get<std::uint32_t>();
  }
}

/// Throws if something is missing or has the wrong type.
EpisodeComparison comparisonOf(const Json& json) {
  EpisodeComparison c;
  c.env = json.at("of").at(0).get<std::uint32_t>();
  c.episode = json.at("of").at(1).get<std::uint32_t>();
  c.end = endOf(json.at("simulation").at(0));
  c.steps = json.at("simulation").at(1).get<std::uint32_t>();
  c.end_in_dynamics = endOf(json.at("dynamics").at(0));
  c.steps_in_dynamics = json.at("dynamics").at(1).get<std::uint32_t>();
  c.success_settled = json.at("settled").get<bool>();
  c.picked_in_dynamics = json.at("picked").get<bool>();
  if (const Json& parted = json.at("parted"); !parted.is_null()) {
    c.parted = parted.get<std::uint32_t>();
  }
  c.base_gap = json.at("base").get<std::vector<float>>();
  c.grip_gap = json.at("grip").get<std::vector<float>>();
  c.tracking_sum = json.at("tracking").at(0).get<double>();
  c.tracking_worst = json.at("tracking").at(1).get<double>();
  takeContacts(json.at("contacts"), c);
  c.disturbed = json.at("disturbed").get<std::uint32_t>();
  for (const Json& one : json.at("rests")) {
    c.rests.push_back({.displacement = one.at(0).get<float>(),
                       .lean = one.at(1).get<float>(),
                       .drop = one.at(2).get<float>(),
                       .step = one.at(3).get<std::uint32_t>(),
                       .world_from_object = poseOf(one.at(4))});
  }
  return c;
}

/// Whether everything exists to which a comparison refers: links of the robot, its own steps, and a
/// gap for each step that both worlds made.
bool isSound(const EpisodeComparison& c, std::size_t links) {
  const auto has_link = [links](const auto& missed) { return std::get<0>(missed.first) < links; };
  const std::size_t steps = std::min(c.steps, c.steps_in_dynamics);
  return c.base_gap.size() == steps && c.grip_gap.size() == steps &&
         (!c.parted || *c.parted < steps) && std::ranges::all_of(c.missed, has_link) &&
         (!c.deepest || (std::get<0>(c.deepest->key) < links && c.deepest->step < c.steps)) &&
         std::ranges::all_of(c.rests, [&c](const Rest& rest) { return rest.step < c.steps; });
}

/// Number and comparison from a record; none if it has another format, or is not sound.
std::optional<std::pair<std::size_t, EpisodeComparison>> readRecord(std::string_view record,
                                                                    std::size_t links) {
  try {
    const Json json = Json::parse(record);
    std::pair one(json.at("number").get<std::size_t>(), comparisonOf(json.at("episode")));
    return isSound(one.second, links) ? std::optional(std::move(one)) : std::nullopt;
  } catch (const Json::exception&) {
    return std::nullopt;
  } catch (const std::out_of_range&) {
    return std::nullopt;
  }
}

}  // namespace

ComparisonJournal::ComparisonJournal(std::unique_ptr<Journal> journal, std::size_t links)
    : journal_(std::move(journal)) {
  for (const std::string_view record : journal_->records()) {
    if (auto one = readRecord(record, links)) done_.insert(std::move(*one));
  }
}

Result<ComparisonJournal> ComparisonJournal::open(const std::filesystem::path& path,
                                                  std::string_view subject, std::size_t links) {
  ASSIGN_OR_RETURN(auto journal, Journal::open(path, subject));
  return ComparisonJournal(std::move(journal), links);
}

Result<void> ComparisonJournal::add(std::size_t number, const EpisodeComparison& comparison) {
  return journal_->add(Json{{"number", number}, {"episode", jsonOf(comparison)}}.dump());
}

}  // namespace galactic::dynamics
