#pragma once
#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace galactic {

// What the command lines that play policies have in common.

/// Why a policy of this name is none of those `expected`.
[[nodiscard]] std::string unknownPolicy(std::string_view name, std::string_view expected);

/// Adds --deterministic and --sampled.
void addSampling(CLI::App& app, bool& is_deterministic);

}  // namespace galactic
