#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "galactic/bake/figures.h"

namespace galactic::bake {

using OrderedJson = nlohmann::ordered_json;

/// Rewrites the sentences for people in a report.
using Rephrase = std::function<std::string(const std::string&)>;

/// The report's entries for a pack: one per object for an object set, one for other kinds.
[[nodiscard]] OrderedJson reportEntries(const PackFigures& figures, const Rephrase& rephrase);

/// A report's description of a pack that a world lists.
[[nodiscard]] OrderedJson jsonOf(const LinkedPack& pack);

/// All figures, for the cache, which never holds worlds.
[[nodiscard]] OrderedJson jsonOf(const PackFigures& figures);

/// The inverse. Returns false if `json` has another form. Throws what nlohmann::json throws if a
/// member is missing or has another type.
[[nodiscard]] bool readFigures(const OrderedJson& json, PackFigures& figures);

}  // namespace galactic::bake
