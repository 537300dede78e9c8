// The images of the `gl` backend in CUDA's memory: OpenGL's buffer, mapped by a library that stands
// in for CUDA's driver. It is loaded under the driver's name, so the backend finds it by that.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "drawn_by_kernels.h"
#include "runtime/render/gl_scene.h"
#include "support/build_paths.h"

namespace galactic::test::gl_mapping_test {
namespace {

using render::RenderEngine;
using render::cuda::CurrentDevice;
using render::cuda::Device;
using render::cuda::Driver;

class GlMapping : public testing::Test {
 protected:
  void SetUp() override {
    GALACTIC_SKIP_WITHOUT_GL();
    standin_ = &resetStandin();
    auto driver = Driver::open(cudaStandIn());
    ASSERT_TRUE(driver) << driver.error().message;
    driver_ = std::move(*driver);
    auto device = Device::choose(*driver_, "");
    ASSERT_TRUE(device) << device.error().message;
    device_ = std::make_unique<Device>(std::move(*device));
    ASSERT_TRUE(device_->open());
    builder_.model();
    builder_.quad({{{2, -1, -1}, {2, -1, 1}, {2, 1, 1}, {2, 1, -1}}});
    builder_.finish();
    library_.add(builder_.meshes());
    options_ = glOptions();
    options_.width = options_.height = 32;
    options_.semantics = true;
    view_.instances = {&instance_, 1};
  }

  std::unique_ptr<RenderEngine> makeGl() {
    auto engine = render::makeGlEngine(library_, options_);
    EXPECT_TRUE(engine) << engine.error().message;
    return engine ? std::move(*engine) : nullptr;
  }

  Standin* standin_ = nullptr;
  std::unique_ptr<Driver> driver_;
  std::unique_ptr<Device> device_;
  RenderModelBuilder builder_;
  RenderLibrary library_;
  RenderInstance instance_;
  RenderView view_;
  RenderOptions options_;
};

TEST_F(GlMapping, HasTheImagesThatAreReadBack) {
  const CurrentDevice current(*driver_, *device_);
  const auto engine = makeGl();
  ASSERT_NE(engine, nullptr);
  // The second batch needs a larger buffer, the third takes what is there.
  for (const std::size_t count : {1U, 70U, 3U}) {
    SCOPED_TRACE(count);
    const std::vector<RenderView> views(count, view_);
    RenderImages read = emptyImages(options_, count);
    engine->begin(views, targetsOf(read));
    engine->end();
    const auto images = engine->renderToDevice(views, 0x5A);
    ASSERT_TRUE(images) << images.error().message;
    EXPECT_EQ(standin_->mapped_buffers, 1);
    EXPECT_EQ(standin_->shared_buffers, 1);
    RenderImages found = emptyImages(options_, count);
    std::memcpy(found.color.data(), std::bit_cast<const void*>(images->color), found.color.size());
    std::memcpy(found.depth.data(), std::bit_cast<const void*>(images->depth),
                4 * found.depth.size());
    std::memcpy(found.semantics.data(), std::bit_cast<const void*>(images->semantics),
                4 * found.semantics.size());
    EXPECT_EQ(found, read);
    EXPECT_NEAR(read.depth[16 * 32 + 16], 2, 0.01);
  }
}

TEST_F(GlMapping, GivesTheBufferBack) {
  const CurrentDevice current(*driver_, *device_);
  {
    const auto engine = makeGl();
    ASSERT_NE(engine, nullptr);
    ASSERT_TRUE(engine->renderToDevice({&view_, 1}, 0));
    EXPECT_EQ(standin_->shared_buffers, 1);
  }
  EXPECT_EQ(standin_->shared_buffers, 0);
  EXPECT_EQ(standin_->mapped_buffers, 0);
}

TEST_F(GlMapping, IsForTheStreamThatUsesTheImages) {
  const CurrentDevice current(*driver_, *device_);
  const auto engine = makeGl();
  ASSERT_NE(engine, nullptr);
  standin_->stream = 0x5A;
  ASSERT_TRUE(engine->renderToDevice({&view_, 1}, 0x5A));
  // Maps, and waits: another stream may use the images, too.
  EXPECT_EQ(standin_->on_stream, 2U);
  EXPECT_EQ(standin_->under_way, 0U);
  // Unmaps for the stream that had the images, and maps for the next.
  ASSERT_TRUE(engine->renderToDevice({&view_, 1}, 0x6B));
  EXPECT_EQ(standin_->on_stream, 3U);
  EXPECT_EQ(standin_->on_others, 2U);
}

TEST_F(GlMapping, SaysOnWhichDeviceTheImagesAre) {
  const auto engine = makeGl();
  ASSERT_NE(engine, nullptr);
  for (const int number : {1, 0}) {
    auto device = Device::choose(*driver_, std::to_string(number));
    ASSERT_TRUE(device) << device.error().message;
    ASSERT_TRUE(device->open());
    const CurrentDevice current(*driver_, *device);
    const auto images = engine->renderToDevice({&view_, 1}, 0);
    ASSERT_TRUE(images) << images.error().message;
    EXPECT_EQ(images->device, number);
  }
}

TEST_F(GlMapping, SaysWhatCudaRefuses) {
  const auto engine = makeGl();
  ASSERT_NE(engine, nullptr);
  const auto without = engine->renderToDevice({&view_, 1}, 0);
  ASSERT_FALSE(without);
  EXPECT_EQ(without.error().message, "no CUDA context is current on this thread; make one first");
  const CurrentDevice current(*driver_, *device_);
  for (const char* function :
       {"cuGraphicsGLRegisterBuffer", "cuGraphicsMapResources", "cuStreamSynchronize"}) {
    standin_->failing = function;
    const auto images = engine->renderToDevice({&view_, 1}, 0);
    ASSERT_FALSE(images) << function;
    EXPECT_EQ(images.error().code, ErrorCode::kUnsupported);
    EXPECT_THAT(images.error().message, testing::HasSubstr("OpenGL's buffer (error 2)"));
  }
  standin_->failing = nullptr;
  EXPECT_TRUE(engine->renderToDevice({&view_, 1}, 0));
}

}  // namespace
}  // namespace galactic::test::gl_mapping_test
