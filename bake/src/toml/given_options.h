#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/bake/option_field.h"
#include "galactic/error.h"
#include "toml/toml_table.h"

namespace galactic::bake {

/// The options in a table of `file`, except keys that `passes` accepts. A list of numbers is one
/// value, each element of a list of texts or of lists is a value, and each entry of a table becomes
/// NAME=VALUE. Fails with kInvalidInput on other values.
[[nodiscard]] Result<std::vector<GivenOption>> givenIn(
    const TomlTable& table, const std::string& file,
    const std::function<bool(std::string_view)>& passes = {});

}  // namespace galactic::bake
