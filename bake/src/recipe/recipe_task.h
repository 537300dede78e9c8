#pragma once
#include <cstdint>
#include <vector>

#include "galactic/option_text.h"
#include "toml/recipe_table.h"
#include "toml/toml_table.h"

namespace galactic::bake {

/// The options of a world's task that the table [task], which begins in `line`, gives: each with
/// its value as listOptions() writes it, in the order of the option table. A preset also gives its
/// parts; a part that is given besides it takes precedence. Reports the first mistake to `errors`.
[[nodiscard]] std::vector<OptionText> readRecipeTask(const TomlTable& table, std::uint32_t line,
                                                     FirstError& errors);

}  // namespace galactic::bake
