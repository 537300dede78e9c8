// Stands in for the `gl` backend if it is not built.
#include "render/render_engine.h"

namespace galactic::render {

Result<std::unique_ptr<RenderEngine>> makeGlEngine(const RenderLibrary& /*library*/,
                                                   const RenderOptions& /*options*/) {
  return fail(ErrorCode::kUnsupported, "render backend gl",
              "the gl backend is not part of this build; use the soft backend, or install "
              "libepoxy-dev and build with GALACTIC_GL=ON");
}

}  // namespace galactic::render
