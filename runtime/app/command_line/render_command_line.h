#pragma once
#include <string>

#include "command_line/render_options.h"

namespace CLI {
class App;
}

namespace galactic {

/// What no single option of drawing can see to be wrong; empty when nothing is. `app` has
/// parsed them.
[[nodiscard]] std::string drawingFault(const DrawingOptions& drawing, const CLI::App& app);

}  // namespace galactic
