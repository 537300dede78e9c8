#pragma once
#include <flatbuffers/flatbuffers.h>

#include <string>

#include "galactic/error.h"

namespace galactic::schema {
struct Option;
struct World;
}  // namespace galactic::schema

namespace galactic::detail {

/// Checks every value of a world's list whose structure has been verified, without looking at the
/// packs that it names.
[[nodiscard]] Result<void> checkWorld(const schema::World& world, const std::string& where);

/// Whether they are options of the task (OptionScope::kTask) in the order of the option table, each
/// at most once, with values that they may have. `field` names the list.
[[nodiscard]] Result<void> checkOptions(
    const flatbuffers::Vector<flatbuffers::Offset<schema::Option>>& options,
    const std::string& field, const std::string& where);

}  // namespace galactic::detail
