// Which device is chosen, and what is said when none will do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include <cstdlib>
#include <memory>

#include "render/device_wish.h"
#include "render/gl/egl_context.h"
#include "render/gl/gl_engine.h"
#include "runtime/render/gl_scene.h"

namespace galactic::render::gl::gl_device_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Kind = DeviceWish::Kind;

const std::vector<DeviceFacts>& mixedDevices() {
  static const std::vector<DeviceFacts> devices{{"/dev/dri/card1", false, std::nullopt},
                                                {"/dev/dri/card0", false, 1},
                                                {"nvidia", false, 0},
                                                {"Mesa's software driver", true, std::nullopt}};
  return devices;
}

TEST(DeviceWishText, ReadsEveryForm) {
  EXPECT_EQ(parseDeviceWish("")->kind, Kind::kFirstGpu);
  EXPECT_EQ(parseDeviceWish("software")->kind, Kind::kSoftware);
  EXPECT_EQ(parseDeviceWish("3")->kind, Kind::kIndex);
  EXPECT_EQ(parseDeviceWish("3")->number, 3U);
  EXPECT_EQ(parseDeviceWish("cuda:12")->kind, Kind::kCuda);
  EXPECT_EQ(parseDeviceWish("cuda:12")->number, 12U);
  const auto uuid = parseDeviceWish("GPU-00010203-0405-0607-0809-0a0B0c0D0eFF");
  ASSERT_TRUE(uuid.has_value());
  EXPECT_EQ(uuid->kind, Kind::kUuid);
  EXPECT_THAT(uuid->uuid, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 255));
}

TEST(DeviceWishText, RefusesAnythingElseAndSaysWhatItWants) {
  for (const char* text : {"gpu", "cuda:", "cuda:x", "-1", "1.5", "4294967296", "Software",
                           "GPU-0001", "000102030405060708090a0b0c0d0eff0"}) {
    const auto wish = parseDeviceWish(text);
    ASSERT_FALSE(wish.has_value()) << text;
    EXPECT_EQ(wish.error().code, ErrorCode::kInvalidInput);
    EXPECT_EQ(wish.error().message,
              std::string("found \"") + text +
                  "\"; expected an index such as 0, cuda:0, a UUID of 32 hexadecimal digits, "
                  "software, or nothing for the first graphics processor");
  }
}

TEST(DeviceChoice, TakesGraphicsProcessorsThatCudaKnowsFirst) {
  EXPECT_THAT(*devicesFor({}, mixedDevices()), ElementsAre(1, 2, 0));
  EXPECT_THAT(*devicesFor({.kind = Kind::kUuid}, mixedDevices()), ElementsAre(1, 2, 0));
}

TEST(DeviceChoice, TakesTheDeviceThatWasNamed) {
  EXPECT_THAT(*devicesFor({.kind = Kind::kIndex, .number = 0}, mixedDevices()), ElementsAre(0));
  EXPECT_THAT(*devicesFor({.kind = Kind::kCuda, .number = 0}, mixedDevices()), ElementsAre(2));
  EXPECT_THAT(*devicesFor({.kind = Kind::kSoftware}, mixedDevices()), ElementsAre(3));
}

TEST(DeviceChoice, TellsWhichDevicesThereAre) {
  constexpr const char* kList =
      "0 (/dev/dri/card1), 1 (/dev/dri/card0, cuda:1), 2 (nvidia, cuda:0), 3 (Mesa's software "
      "driver, software)";
  const auto index = devicesFor({.kind = Kind::kIndex, .number = 4}, mixedDevices());
  ASSERT_FALSE(index.has_value());
  EXPECT_EQ(index.error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(index.error().message, std::string("found no device 4; EGL lists ") + kList);
  const auto cuda = devicesFor({.kind = Kind::kCuda, .number = 7}, mixedDevices());
  ASSERT_FALSE(cuda.has_value());
  EXPECT_EQ(cuda.error().message,
            std::string("found no device that is cuda:7; EGL lists ") + kList +
                ". CUDA_VISIBLE_DEVICES changes CUDA's numbers, and a container needs the driver "
                "capability \"graphics\"");
  const auto none = devicesFor({.kind = Kind::kIndex, .number = 0}, {});
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().message, "found no device 0; EGL lists none");
}

TEST(DeviceChoice, NeverTakesASoftwareDriverForAGraphicsProcessor) {
  const std::vector<DeviceFacts> software{{"Mesa's software driver", true, std::nullopt}};
  const auto first = devicesFor({}, software);
  ASSERT_FALSE(first.has_value());
  EXPECT_THAT(first.error().message,
              HasSubstr("found only the software driver \"Mesa's software driver\""));
  const auto index = devicesFor({.kind = Kind::kIndex, .number = 0}, software);
  ASSERT_FALSE(index.has_value());
  EXPECT_EQ(index.error().message,
            "device 0 is a software driver, not a graphics processor; ask for \"software\" or the "
            "soft backend for software. EGL lists 0 (Mesa's software driver, software)");
}

TEST(ContextChoice, RefusesAnOldOpenGl) {
  const auto judged = judgeContext({}, {4, 3, "Old Card 100", std::nullopt});
  ASSERT_FALSE(judged.has_value());
  EXPECT_EQ(judged.error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(judged.error().message,
            "the driver \"Old Card 100\" has OpenGL 4.3; expected 4.5 or newer: update the driver, "
            "or use the soft backend");
  EXPECT_TRUE(judgeContext({}, {4, 5, "Card", std::nullopt}).has_value());
  EXPECT_TRUE(judgeContext({}, {5, 0, "Card", std::nullopt}).has_value());
}

TEST(ContextChoice, RefusesASoftwareDriverWhereAGraphicsProcessorWasAskedFor) {
  const auto judged = judgeContext({}, {4, 5, "llvmpipe (LLVM 15)", std::nullopt});
  ASSERT_FALSE(judged.has_value());
  EXPECT_EQ(judged.error().message,
            "found only the software driver \"llvmpipe (LLVM 15)\"; expected a graphics processor: "
            "ask for the device \"software\" or use the soft backend, or install the graphics "
            "processor's driver (in a container, with the capability \"graphics\")");
  const DeviceWish software{.kind = Kind::kSoftware};
  EXPECT_TRUE(judgeContext(software, {4, 5, "llvmpipe (LLVM 15)", std::nullopt}).has_value());
  const auto hardware = judgeContext(software, {4, 6, "Card", std::nullopt});
  ASSERT_FALSE(hardware.has_value());
  EXPECT_THAT(hardware.error().message, HasSubstr("found the graphics processor \"Card\""));
}

TEST(ContextChoice, ComparesTheUuid) {
  const auto wish = parseDeviceWish("00010203-0405-0607-0809-0a0b0c0d0e0f");
  ASSERT_TRUE(wish.has_value());
  EXPECT_TRUE(judgeContext(*wish, {4, 6, "Card", wish->uuid}).has_value());
  const auto other = judgeContext(*wish, {4, 6, "Card", DeviceUuid{}});
  ASSERT_FALSE(other.has_value());
  EXPECT_EQ(other.error().message,
            "the graphics processor \"Card\" has the UUID 00000000-0000-0000-0000-000000000000; "
            "expected 00010203-0405-0607-0809-0a0b0c0d0e0f");
  EXPECT_FALSE(judgeContext(*wish, {4, 6, "Card", std::nullopt}).has_value());
}

TEST(GlStart, NamesThePackageWhereEglIsMissing) {
  const auto none = checkLibraries([](const char*) { return false; });
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(none.error().message,
            "found no libEGL.so.1; install libegl1 (and libgl1-mesa-dri for the software driver), "
            "or use the soft backend");
  const auto no_gl =
      checkLibraries([](const char* name) { return std::string(name) == "libEGL.so.1"; });
  ASSERT_FALSE(no_gl.has_value());
  EXPECT_EQ(no_gl.error().message,
            "found neither libOpenGL.so.0 nor libGL.so.1; install libopengl0, or use the soft "
            "backend");
  EXPECT_TRUE(checkLibraries([](const char* name) {
                return std::string(name) != "libOpenGL.so.0";
              }).has_value());
}

TEST(GlStart, AsksForTheLibrariesBeforeItOpensAnything) {
  const RenderLibrary library;
  const auto engine =
      GlEngine::make(library, test::glOptions(), {}, [](const char*) { return false; });
  ASSERT_FALSE(engine.has_value());
  EXPECT_THAT(engine.error().message, HasSubstr("install libegl1"));
}

TEST(GlStart, ReportsTheDriversRendererString) {
  GALACTIC_SKIP_WITHOUT_GL();
  const RenderLibrary library;
  const Result<BatchRenderer> renderer = BatchRenderer::create(library, test::glOptions());
  ASSERT_TRUE(renderer.has_value());
  EXPECT_EQ(renderer->backend(), RenderBackend::kGl);
  EXPECT_THAT(renderer->description(), testing::StartsWith("gl, "));
  EXPECT_TRUE(isSoftwareRenderer(renderer->description())) << renderer->description();
}

#ifdef __GLIBC__
/// How many blocks of memory are mapped while there is one more that is larger than any threshold
/// which glibc finds out for itself.
std::size_t mappedBlocks() {
  constexpr std::size_t kBytes = std::size_t{64} << 20U;
  const std::unique_ptr<void, void (*)(void*)> block(std::malloc(kBytes), std::free);
  // Nobody may leave it out.
  *static_cast<volatile char*>(block.get()) = 1;
  return mallinfo2().hblks;
}

TEST(GlStart, LeavesTheProgramsAllocatorAsItIs) {
  GALACTIC_SKIP_WITHOUT_GL();
  if (mappedBlocks() == 0) GTEST_SKIP() << "the allocator is not glibc's";
  const Result<BatchRenderer> renderer = BatchRenderer::create(RenderLibrary(), test::glOptions());
  ASSERT_TRUE(renderer.has_value());
  const std::size_t without = mallinfo2().hblks;
  EXPECT_EQ(mappedBlocks(), without + 1);
}
#endif

TEST(GlStart, FindsNoDeviceBeyondTheLast) {
  GALACTIC_SKIP_WITHOUT_GL();
  RenderOptions options = test::glOptions();
  options.device = "99";
  const auto renderer = BatchRenderer::create(RenderLibrary(), options);
  ASSERT_FALSE(renderer.has_value());
  EXPECT_EQ(renderer.error().code, ErrorCode::kUnsupported);
  EXPECT_THAT(renderer.error().message, testing::StartsWith("found no device 99; EGL lists "));
}

TEST(GlStart, NamesTheSoftwareDriverWhereNothingElseIsFound) {
  GALACTIC_SKIP_WITHOUT_GL();
  RenderOptions options = test::glOptions();
  options.device.clear();
  const auto renderer = BatchRenderer::create(RenderLibrary(), options);
  if (renderer) GTEST_SKIP() << "this machine has " << renderer->description();
  EXPECT_THAT(renderer.error().message, HasSubstr("ask for the device \"software\" or use the soft "
                                                  "backend"));
  EXPECT_THAT(renderer.error().message, HasSubstr("llvmpipe"));
}

TEST(GlStart, LeavesTheCallersContextCurrent) {
  GALACTIC_SKIP_WITHOUT_GL();
  const Result<EglContext> own = openContext({.kind = Kind::kSoftware}, false);
  ASSERT_TRUE(own.has_value());
  const EGLContext before = eglGetCurrentContext();
  {
    const CurrentContext current(*own);
    ASSERT_TRUE(current.holds());
    const RenderLibrary library;
    auto renderer = test::makeRenderer(library, test::glOptions());
    EXPECT_EQ(eglGetCurrentContext(), own->handle());
    test::renderViews(renderer, std::vector<RenderView>(2));
    EXPECT_EQ(eglGetCurrentContext(), own->handle());
  }
  EXPECT_EQ(eglGetCurrentContext(), before);
}

}  // namespace
}  // namespace galactic::render::gl::gl_device_test
