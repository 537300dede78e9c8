#pragma once
#include <string>

#include "galactic/error.h"

namespace galactic::schema {
struct World;
}

namespace galactic::detail {

/// Checks every value of a world's list whose structure has been verified, without looking at the
/// packs that it names.
[[nodiscard]] Result<void> checkWorld(const schema::World& world, const std::string& where);

}  // namespace galactic::detail
