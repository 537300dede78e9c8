#pragma once
#include <cstddef>
#include <span>
#include <string>

#include "galactic/error.h"

namespace galactic::schema {
struct Scene;
}

namespace galactic::detail {

/// Checks every value of a scene whose structure has been verified. `file`: the whole pack.
[[nodiscard]] Result<void> checkScene(const schema::Scene& scene, std::span<const std::byte> file,
                                      const std::string& where);

}  // namespace galactic::detail
