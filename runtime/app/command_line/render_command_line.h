#pragma once
#include <string>

#include "command_line/render_options.h"

namespace CLI {
class App;
}

namespace galactic {

/// What is wrong with the drawing options taken together; empty if nothing is. `app` must have
/// parsed them.
[[nodiscard]] std::string drawingFault(const DrawingOptions& drawing, const CLI::App& app);

}  // namespace galactic
