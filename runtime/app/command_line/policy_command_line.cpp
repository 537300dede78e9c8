#include "command_line/policy_command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>

#include "support/text/number_text.h"

namespace galactic {

std::string unknownPolicy(std::string_view name, std::string_view expected) {
  const bool is_checkpoint = name.ends_with(".pt");
  return fmt::format("unknown policy {}, expected {}{}", name, expected,
                     is_checkpoint ? "; python3 -m galactic.export makes a policy pack of it" : "");
}

void addSampling(CLI::App& app, bool& is_deterministic) {
  // An explicit text keeps --help from listing which options exclude each other.
  constexpr const char* kNoText = " ";
  CLI::Option* likeliest = app.add_flag("--deterministic", is_deterministic,
                                        "Let a policy pack take its likeliest actions")
                               ->check(switchCheck())
                               ->option_text(kNoText);
  const auto sample = [&is_deterministic](std::int64_t times) { is_deterministic = times <= 0; };
  app.add_flag_function("--sampled", sample, "Let it sample its actions, as it does by default")
      ->check(switchCheck())
      ->excludes(likeliest)
      ->option_text(kNoText);
}

}  // namespace galactic
