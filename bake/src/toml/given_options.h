#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/bake/option_field.h"
#include "galactic/error.h"
#include "toml/toml_table.h"

namespace galactic::bake {

/// The options of a table in `file`, without those that `passes` lets pass. A list of numbers is
/// one value, a list of texts or of lists are several, a table gives NAME=VALUE each. Fails with
/// kInvalidInput on values that are none of these.
[[nodiscard]] Result<std::vector<GivenOption>> givenIn(
    const TomlTable& table, const std::string& file,
    const std::function<bool(std::string_view)>& passes = {});

}  // namespace galactic::bake
