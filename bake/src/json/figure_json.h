#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "galactic/bake/figures.h"

namespace galactic::bake {

using OrderedJson = nlohmann::ordered_json;

/// What becomes of the sentences for people in a report.
using Rephrase = std::function<std::string(const std::string&)>;

/// The pack's entries of a report: one for each object, of other kinds one.
[[nodiscard]] OrderedJson reportEntries(const PackFigures& figures, const Rephrase& rephrase);

/// How a report describes a pack that a world lists.
[[nodiscard]] OrderedJson jsonOf(const LinkedPack& pack);

/// Everything, for the cache. Worlds are never in it.
[[nodiscard]] OrderedJson jsonOf(const PackFigures& figures);

/// The inverse. False where `json` is of another form; throws what nlohmann::json throws where a
/// member is missing or has another type.
[[nodiscard]] bool readFigures(const OrderedJson& json, PackFigures& figures);

}  // namespace galactic::bake
