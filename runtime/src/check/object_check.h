#pragma once
#include <string>

#include "galactic/error.h"

namespace galactic::schema {
struct ObjectSet;
}

namespace galactic::detail {

/// Checks every value of an object set whose structure has been verified.
[[nodiscard]] Result<void> checkObjectSet(const schema::ObjectSet& set, const std::string& where);

}  // namespace galactic::detail
