#pragma once
#include <flatbuffers/flatbuffers.h>

#include <string>

#include "galactic/error.h"

namespace galactic::schema {
struct Option;
struct World;
}  // namespace galactic::schema

namespace galactic::detail {

/// Checks every value of a world's list of packs, whose structure has been verified, without
/// opening the packs.
[[nodiscard]] Result<void> checkWorld(const schema::World& world, const std::string& where);

/// Checks that these are options of the task (OptionScope::kTask) in the order of the option table,
/// each given at most once and with a valid value. `field` names the list.
[[nodiscard]] Result<void> checkOptions(
    const flatbuffers::Vector<flatbuffers::Offset<schema::Option>>& options,
    const std::string& field, const std::string& where);

}  // namespace galactic::detail
