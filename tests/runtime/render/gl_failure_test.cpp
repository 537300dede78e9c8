// What is thrown when OpenGL fails in the middle of the work, and that images are right afterwards.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "render/gl/egl_context.h"
#include "render/gl/gl_engine.h"
#include "runtime/render/gl_scene.h"
#include "support/limited_memory.h"
#include "support/sanitized.h"

namespace galactic::render::gl::gl_failure_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// What is thrown, in words.
template <class Act>
std::string thrownBy(const Act& act) {
  try {
    act();
  } catch (const ErrorException& thrown) {
    EXPECT_EQ(thrown.error().code, ErrorCode::kUnsupported);
    EXPECT_EQ(thrown.error().where, "render device");
    return thrown.error().message;
  }
  return "nothing";
}

/// Closes a display as another part of the program would, whoever uses it.
void closeDisplay(const EglContext& context) {
  while (CurrentContext(context).holds()) eglTerminate(context.display());
}

std::unique_ptr<GlEngine> makeEngine(const RenderLibrary& library, const RenderOptions& options,
                                     const GlTuning& tuning = {}) {
  auto engine = GlEngine::make(library, options, tuning, loadsLibrary);
  EXPECT_TRUE(engine.has_value()) << engine.error().message;
  return engine ? std::move(*engine) : nullptr;
}

/// Stands between the renderer, which has drawn before, and the driver's fences, which run out.
class ScarceFences {
 public:
  explicit ScarceFences(int supply) {
    supply_ = supply;
    open_ = 0;
    fence_ = std::exchange(epoxy_glFenceSync, &fence);
    drop_ = std::exchange(epoxy_glDeleteSync, &drop);
  }
  ~ScarceFences() {
    epoxy_glFenceSync = fence_;
    epoxy_glDeleteSync = drop_;
  }
  ScarceFences(const ScarceFences&) = delete;
  ScarceFences& operator=(const ScarceFences&) = delete;

  void supply(int fences) { supply_ = fences; }
  /// Fences that were given and not given back.
  [[nodiscard]] int open() const { return open_; }

 private:
  static GLsync fence(GLenum condition, GLbitfield flags) {
    if (supply_ == 0) return nullptr;
    --supply_;
    ++open_;
    return fence_(condition, flags);
  }
  static void drop(GLsync sync) {
    if (sync != nullptr) --open_;
    drop_(sync);
  }

  // OpenGL's functions know of no object.
  static inline int supply_ = 0;
  static inline int open_ = 0;
  static inline PFNGLFENCESYNCPROC fence_ = nullptr;
  static inline PFNGLDELETESYNCPROC drop_ = nullptr;
};

TEST(GlFailure, ThrowsWhereMemoryIsLackingAndDrawsAgainAfterwards) {
  GALACTIC_SKIP_WITHOUT_GL();
  if (test::kIsSanitized) GTEST_SKIP() << "a sanitizer maps more than a limit could allow";
  RenderOptions options = test::glOptions();
  options.width = options.height = kLargestImage;
  options.semantics = true;
  const RenderLibrary library;
  auto renderer = test::makeRenderer(library, options);
  const std::size_t pixels = std::size_t{kLargestImage} * kLargestImage;
  std::vector<std::uint8_t> color(pixels * static_cast<std::size_t>(options.color));
  std::vector<float> depth(pixels, 1);
  std::vector<std::uint32_t> semantics(pixels, 1);
  const RenderView view;
  const auto draw = [&] { renderer.render({&view, 1}, {color, depth, semantics}); };
  {
    // The images need some 400 MB.
    const test::LimitedMemory limit(std::uint64_t{150} << 20U);
    EXPECT_THROW(draw(), ErrorException);
    // It has not begun.
    EXPECT_THROW(renderer.endRender(), ErrorException);
  }
  draw();
  EXPECT_EQ(depth, std::vector<float>(pixels));
  EXPECT_EQ(semantics, std::vector<std::uint32_t>(pixels));
}

TEST(GlFailure, ThrowsWhereTheDriverRefusesACallAndDrawsAgainAfterwards) {
  GALACTIC_SKIP_WITHOUT_GL();
  const Result<EglContext> context = openContext({.kind = DeviceWish::Kind::kSoftware}, false);
  ASSERT_TRUE(context.has_value());
  const CurrentContext current(*context);
  const RenderLibrary library;
  const RenderOptions options = test::glOptions();
  auto renderer = GlRenderer::make(library, options, {});
  ASSERT_TRUE(renderer.has_value());
  test::RenderImages images = test::emptyImages(options, 1);
  ViewSlice slice;
  const std::vector<RenderView> views(1);
  const auto draw = [&] {
    (*renderer)->submit(views, slice);
    (*renderer)->collect(slice, test::targetsOf(images));
  };
  draw();
  glEnable(GL_TRIANGLES);
  try {
    draw();
    ADD_FAILURE() << "nothing was thrown";
  } catch (const ErrorException& thrown) {
    EXPECT_EQ(thrown.error().code, ErrorCode::kUnsupported);
    EXPECT_EQ(thrown.error().message,
              "the driver does not draw 1 images of 128 x 128 pixels (OpenGL error 0x0500); draw "
              "fewer at once or smaller ones, or use the soft backend");
  }
  EXPECT_EQ(slice.fence, nullptr);
  images = test::emptyImages(options, 1);
  draw();
  EXPECT_EQ(images.depth, std::vector<float>(images.depth.size()));
}

TEST(GlFailure, ThrowsWhereADrawingIsLostAndDrawsAgainAfterwards) {
  GALACTIC_SKIP_WITHOUT_GL();
  const Result<EglContext> context = openContext({.kind = DeviceWish::Kind::kSoftware}, false);
  ASSERT_TRUE(context.has_value());
  const CurrentContext current(*context);
  const RenderLibrary library;
  const RenderOptions options = test::glOptions();
  auto renderer = GlRenderer::make(library, options, {});
  ASSERT_TRUE(renderer.has_value());
  test::RenderImages images = test::emptyImages(options, 1);
  ViewSlice slice;
  const std::vector<RenderView> views(1);
  (*renderer)->submit(views, slice);
  glDeleteSync(slice.fence);
  EXPECT_EQ(thrownBy([&] { (*renderer)->collect(slice, test::targetsOf(images)); }),
            "the driver does not draw 1 images of 128 x 128 pixels (OpenGL error 0x0501); draw "
            "fewer at once or smaller ones, or use the soft backend");
  EXPECT_EQ(slice.fence, nullptr);
  EXPECT_EQ(images, test::emptyImages(options, 1));
  (*renderer)->submit(views, slice);
  (*renderer)->collect(slice, test::targetsOf(images));
  EXPECT_EQ(images.depth, std::vector<float>(images.depth.size()));
}

TEST(GlFailure, FinishesWhatAFailedBatchLeftBehindBeforeTheNext) {
  GALACTIC_SKIP_WITHOUT_GL();
  test::GlHome home;
  const std::vector<RenderView> views = home.views(3);
  const RenderOptions options = test::glOptions();
  const auto engine = makeEngine(home.library(), options, {.most_views = 1});
  ASSERT_NE(engine, nullptr);
  const auto draw = [&] {
    test::RenderImages images = test::emptyImages(options, views.size());
    engine->begin(views, test::targetsOf(images));
    engine->end();
    return images;
  };
  const test::RenderImages wanted = draw();
  ScarceFences fences(1);
  EXPECT_THAT(thrownBy(draw), HasSubstr("the driver does not draw 1 images"));
  EXPECT_EQ(fences.open(), 1);
  // What was left behind counts in no batch's statistics.
  fences.supply(100);
  EXPECT_EQ(draw(), wanted);
  EXPECT_EQ(fences.open(), 0);
  EXPECT_EQ(engine->statistics().instances, 3 * views[0].instances.size());
  fences.supply(1);
  EXPECT_THAT(thrownBy(draw), HasSubstr("the driver does not draw 1 images"));
  fences.supply(100);
  EXPECT_TRUE(engine->drawToDevice(views).has_value());
  EXPECT_EQ(fences.open(), 0);
  // That batch is over.
  engine->end();
}

TEST(GlFailure, ThrowsWhereTheDisplayWasClosed) {
  GALACTIC_SKIP_WITHOUT_GL();
  test::GlHome home;
  const std::vector<RenderView> views = home.views(20);
  const RenderOptions options = test::glOptions();
  test::RenderImages images = test::emptyImages(options, views.size());
  test::RenderImages lacking = images;
  test::RenderImages again = images;
  const RenderTargets targets = test::targetsOf(images);
  auto engine = makeEngine(home.library(), options);
  auto half_way = makeEngine(home.library(), options);
  ASSERT_NE(engine, nullptr);
  ASSERT_NE(half_way, nullptr);
  engine->begin(views, targets);
  engine->end();
  half_way->begin(views, test::targetsOf(lacking));
  closeDisplay(engine->context());
  const auto lost =
      AllOf(HasSubstr("EGL no longer has the renderer's context (EGL error 0x30"),
            HasSubstr("): another part of the program may have closed the display (eglTerminate); "
                      "make another renderer, or use the soft backend"));
  EXPECT_THAT(thrownBy([&] { half_way->end(); }), lost);
  EXPECT_THAT(thrownBy([&] { engine->begin(views, targets); }), lost);
  // Who ends the batch all the same finds nothing to wait for.
  engine->end();
  EXPECT_THAT(engine->drawToDevice(views).error().message, lost);
  EXPECT_THAT(engine->renderToDevice(views, 0).error().message, lost);
  engine.reset();
  half_way.reset();
  engine = makeEngine(home.library(), options);
  ASSERT_NE(engine, nullptr);
  engine->begin(views, test::targetsOf(again));
  engine->end();
  EXPECT_EQ(again, images);
}

TEST(GlFailure, LeavesTheCallersObjectsAloneWhereItsOwnAreLost) {
  GALACTIC_SKIP_WITHOUT_GL();
  const RenderLibrary library;
  auto engine = makeEngine(library, test::glOptions());
  ASSERT_NE(engine, nullptr);
  // A display of the caller's, which stays open.
  const EGLDisplay display =
      eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display == engine->context().display() || !eglInitialize(display, nullptr, nullptr)) {
    GTEST_SKIP() << "EGL has no second display";
  }
  eglBindAPI(EGL_OPENGL_API);
  const EglContext own(display,
                       eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, nullptr));
  const CurrentContext current(own);
  ASSERT_TRUE(current.holds());
  std::array<GLuint, 100> buffers{};
  glCreateBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
  closeDisplay(engine->context());
  engine.reset();
  EXPECT_EQ(eglGetCurrentContext(), own.handle());
  for (const GLuint buffer : buffers) EXPECT_TRUE(glIsBuffer(buffer)) << buffer;
}

}  // namespace
}  // namespace galactic::render::gl::gl_failure_test
