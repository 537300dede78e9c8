#pragma once
#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace galactic {

// What the command lines of programs that play policies have in common.

/// The message that a policy of this name is unknown; `expected` lists the policies.
[[nodiscard]] std::string unknownPolicy(std::string_view name, std::string_view expected);

/// Adds --deterministic and --sampled.
void addSampling(CLI::App& app, bool& is_deterministic);

}  // namespace galactic
