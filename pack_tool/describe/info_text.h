#pragma once
#include <string>

#include "pack_tool/describe/pack_description.h"

namespace galactic::pack_tool {

/// A description of describePack as text for people, one grid per column of its table.
[[nodiscard]] std::string infoText(const Json& description);

}  // namespace galactic::pack_tool
