#pragma once
#include <string>
#include <string_view>

#include "pack_tool/describe/pack_description.h"

namespace galactic::pack_tool {

// Parts of descriptions as text for people.

/// A text without control characters.
[[nodiscard]] std::string textOf(const Json& json);

/// A whole number with commas between thousands.
[[nodiscard]] std::string countOf(const Json& json);

/// How many there are, with their noun: "1 mesh", "1,024 meshes".
[[nodiscard]] std::string countedOf(const Json& count, std::string_view one);

/// A number, NaN when it is null: a trusted pack may hold anything.
[[nodiscard]] double numberOf(const Json& json);

/// A length as short as it can be written.
[[nodiscard]] std::string lengthOf(const Json& json);

/// (x, y, z) with four decimals.
[[nodiscard]] std::string pointOf(const Json& json);

/// Mean, 95th percentile and maximum in millimeters; "-" where there is nothing.
[[nodiscard]] std::string millimetersOf(const Json& lengths);

/// The number of spheres of each radius, largest radius first, as "1+4+2"; and of all.
[[nodiscard]] std::string countsByRadius(const Json& spheres, const Json& radii);

/// The radii, largest first, in meters.
[[nodiscard]] std::string radiiOf(const Json& radii);

}  // namespace galactic::pack_tool
