// The processor's side of the cuda backend, against a library that stands in for CUDA's driver.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include "drawn_by_kernels.h"
#include "support/packs/render_model_builder.h"

namespace galactic::test::cuda_host_test {
namespace {

using testing::HasSubstr;

class CudaHost : public testing::Test {
 protected:
  void SetUp() override {
    if (!hasKernels()) GTEST_SKIP() << "built without the kernels";
    standin_ = &resetStandin();
    builder_.model();
    builder_.quad({{{2, -1, -1}, {2, -1, 1}, {2, 1, 1}, {2, 1, -1}}});
    builder_.finish();
    library_.add(builder_.meshes());
    options_.width = options_.height = 32;
    view_.instances = {&instance_, 1};
  }

  std::string errorOf(const RenderOptions& options) {
    const auto engine = makeEngine(library_, options);
    return engine ? "made" : engine.error().message;
  }

  Standin* standin_ = nullptr;
  RenderModelBuilder builder_;
  RenderLibrary library_;
  RenderInstance instance_;
  RenderView view_;
  RenderOptions options_;
};

TEST_F(CudaHost, SaysWhatItIs) {
  const auto engine = makeEngine(library_, options_);
  ASSERT_TRUE(engine) << engine.error().message;
  EXPECT_EQ((*engine)->description(), "cuda, Stand-in A, compute capability 9.0");
  EXPECT_EQ((*engine)->backend(), RenderBackend::kCuda);
}

TEST_F(CudaHost, ChoosesTheDeviceThatIsAskedFor) {
  for (const char* wish : {"1", "cuda:1", "GPU-10111213-1415-1617-1819-1a1b1c1d1e1f"}) {
    options_.device = wish;
    const auto engine = makeEngine(library_, options_);
    ASSERT_TRUE(engine) << engine.error().message;
    EXPECT_EQ((*engine)->device().name(), "Stand-in B") << wish;
  }
}

TEST_F(CudaHost, NamesADeviceThatIsNotThere) {
  options_.device = "2";
  EXPECT_EQ(
      errorOf(options_),
      "found device 2 asked for, but CUDA has 2 (0 to 1); CUDA_VISIBLE_DEVICES may hide some");
  options_.device = "00000000-0000-0000-0000-000000000000";
  EXPECT_THAT(errorOf(options_), HasSubstr("none of CUDA's 2 devices has the UUID"));
  options_.device = "software";
  EXPECT_THAT(errorOf(options_), HasSubstr("ask for the soft backend"));
  options_.device = "the red one";
  const auto engine = makeEngine(library_, options_);
  ASSERT_FALSE(engine);
  EXPECT_EQ(engine.error().code, ErrorCode::kInvalidInput);
}

/// An environment variable, for a while.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) { setenv(name, value, 1); }
  ~Variable() { unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

TEST_F(CudaHost, CountsTheDevicesThatCudaVisibleDevicesLeaves) {
  const std::string a = "GPU-00010203-0405-0607-0809-0a0b0c0d0e0f";
  const std::string b = "GPU-10111213-1415-1617-1819-1a1b1c1d1e1f";
  const auto nameOf = [&](const std::string& wish) {
    options_.device = wish;
    const auto engine = makeEngine(library_, options_);
    return engine ? (*engine)->device().name() : engine.error().message;
  };
  for (const std::string& visible : {std::string("1"), b, std::string("GPU-1011"), "1,7," + a}) {
    SCOPED_TRACE(visible);
    const Variable variable("CUDA_VISIBLE_DEVICES", visible.c_str());
    EXPECT_EQ(nameOf(""), "Stand-in B");
    EXPECT_EQ(nameOf("0"), "Stand-in B");
    EXPECT_EQ(nameOf("cuda:0"), "Stand-in B");
    EXPECT_EQ(nameOf(b), "Stand-in B");
    EXPECT_EQ(
        nameOf("1"),
        "found device 1 asked for, but CUDA has 1 (0 to 0); CUDA_VISIBLE_DEVICES may hide some");
    EXPECT_THAT(nameOf(a), HasSubstr("none of CUDA's 1 devices has the UUID"));
  }
  {
    const Variable turned("CUDA_VISIBLE_DEVICES", "1,0");
    EXPECT_EQ(nameOf("0"), "Stand-in B");
    EXPECT_EQ(nameOf("1"), "Stand-in A");
    EXPECT_EQ(nameOf(a), "Stand-in A");
  }
  const Variable none("CUDA_VISIBLE_DEVICES", "");
  EXPECT_EQ(nameOf(""),
            "CUDA's driver finds no device; CUDA_VISIBLE_DEVICES may hide those there are");
}

TEST_F(CudaHost, SaysWhatIsMissing) {
  const auto absent = render::cuda::CudaEngine::make(library_, options_, {.library = "/no/lib.so"});
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(absent.error().message,
            "found no /no/lib.so; install NVIDIA's driver, or use the soft backend");
  const auto strange = render::cuda::CudaEngine::make(library_, options_, {.library = "libm.so.6"});
  ASSERT_FALSE(strange);
  EXPECT_EQ(strange.error().message, "libm.so.6 is too old: it has no cuInit");
  standin_->devices = 0;
  EXPECT_THAT(errorOf(options_), HasSubstr("finds no device"));
  standin_->devices = 1;
  standin_->major = 6;
  standin_->minor = 1;
  EXPECT_EQ(errorOf(options_), "Stand-in A has compute capability 6.1; expected 7.0 or more");
}

TEST_F(CudaHost, PassesOnWhatTheDriverRefuses) {
  standin_->failing = "cuInit";
  EXPECT_EQ(errorOf(options_), "CUDA's driver could not start: error 2 (CUDA_ERROR_OUT_OF_MEMORY)");
  standin_->failing = "cuModuleLoadDataEx";
  EXPECT_THAT(errorOf(options_), HasSubstr("compile the kernels: ptxas says no"));
  standin_->failing = "cuMemAlloc";
  EXPECT_THAT(errorOf(options_), HasSubstr("on the device: error 2"));
  standin_->failing = nullptr;
  auto engine = makeEngine(library_, options_);
  ASSERT_TRUE(engine);
  for (const char* function : {"cuMemAlloc", "cuLaunchKernel", "cuStreamSynchronize"}) {
    standin_->failing = function;
    const auto images = (*engine)->renderToDevice({&view_, 1}, 0);
    ASSERT_FALSE(images) << function;
    EXPECT_EQ(standin_->under_way, 0U) << function;
    EXPECT_EQ(images.error().code, ErrorCode::kUnsupported);
    standin_->failing = nullptr;
    ASSERT_TRUE((*engine)->renderToDevice({&view_, 1}, 0));
  }
}

TEST_F(CudaHost, ThrowsWhereImagesWouldBeWrongAndDrawsAgainAfterwards) {
  auto engine = makeEngine(library_, options_);
  ASSERT_TRUE(engine);
  RenderImages images = emptyImages(options_, 1);
  const auto draw = [&] {
    (*engine)->begin({&view_, 1}, targetsOf(images));
    (*engine)->end();
  };
  const auto thrown_by = [&](const char* failing) -> std::string {
    standin_->failing = failing;
    std::string thrown = "nothing";
    try {
      draw();
    } catch (const ErrorException& failure) {
      EXPECT_EQ(failure.error().code, ErrorCode::kUnsupported);
      thrown = failure.what();
    }
    EXPECT_EQ(standin_->under_way, 0U) << failing;
    // There is nothing to wait for.
    (*engine)->end();
    return thrown;
  };
  EXPECT_THAT(thrown_by("cuMemAlloc"), HasSubstr("on the device: error 2"));
  EXPECT_THAT(thrown_by("cuLaunchKernel"), HasSubstr("could not launch a kernel"));
  EXPECT_THAT(thrown_by("cuStreamSynchronize"), HasSubstr("could not draw"));
  standin_->failing = nullptr;
  draw();
  const auto black = [](std::uint8_t channel) { return channel == 0; };
  EXPECT_FALSE(std::ranges::all_of(images.color, black));
}

TEST_F(CudaHost, LeavesTheContextOfOthersAloneWhereItsOwnCannotBeCurrent) {
  auto engine = makeEngine(library_, options_);
  ASSERT_TRUE(engine);
  auto driver = render::cuda::Driver::open(cudaStandIn());
  ASSERT_TRUE(driver) << driver.error().message;
  auto others = render::cuda::Device::choose(**driver, "1");
  ASSERT_TRUE(others) << others.error().message;
  ASSERT_TRUE(others->open());
  const render::cuda::CurrentDevice current(**driver, *others);
  RenderImages images = emptyImages(options_, 1);
  const auto refusal = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const ErrorException& failure) {
      return failure.what();
    }
    return "nothing";
  };
  const auto begin = [&] { (*engine)->begin({&view_, 1}, targetsOf(images)); };
  const auto end = [&] { (*engine)->end(); };
  const std::string why = "CUDA's driver could not make the renderer's context current: error 2";
  standin_->failing = "cuCtxPushCurrent";
  EXPECT_THAT(errorOf(options_), HasSubstr(why));
  EXPECT_THAT(refusal(begin), HasSubstr(why));
  EXPECT_EQ(refusal(end), "nothing");
  const auto on_device = (*engine)->renderToDevice({&view_, 1}, 0);
  ASSERT_FALSE(on_device);
  EXPECT_THAT(on_device.error().message, HasSubstr(why));
  standin_->failing = nullptr;
  EXPECT_EQ(refusal(begin), "nothing");
  EXPECT_EQ(standin_->pushed_contexts, 1);
  standin_->failing = "cuCtxPushCurrent";
  EXPECT_THAT(refusal(end), HasSubstr(why));
  EXPECT_EQ(refusal(end), "nothing");
  EXPECT_GT(standin_->under_way, 0U);
  // Nothing of it is left to the next batch.
  standin_->failing = nullptr;
  EXPECT_EQ(refusal(begin), "nothing");
  EXPECT_EQ(refusal(end), "nothing");
  EXPECT_EQ(standin_->under_way, 0U);
  EXPECT_EQ(images, drawWithSoft(library_, options_, {&view_, 1}));
  standin_->failing = "cuCtxPushCurrent";
  engine->reset();
  EXPECT_EQ(standin_->pushed_contexts, 1);
}

TEST_F(CudaHost, GivesEverythingBack) {
  const std::uint64_t before = standin_->allocations;
  {
    auto engine = makeEngine(library_, options_);
    ASSERT_TRUE(engine);
    ASSERT_TRUE((*engine)->renderToDevice({&view_, 1}, 0));
    EXPECT_GT(standin_->allocations, before);
    EXPECT_EQ(standin_->contexts, 1);
    EXPECT_EQ(standin_->modules, 1);
  }
  EXPECT_EQ(standin_->allocations, before);
  EXPECT_EQ(standin_->contexts, 0);
  EXPECT_EQ(standin_->modules, 0);
}

TEST_F(CudaHost, ReservesNothingMoreForTheSameBatch) {
  auto engine = makeEngine(library_, options_);
  ASSERT_TRUE(engine);
  const std::vector<RenderView> views(5, view_);
  ASSERT_TRUE((*engine)->renderToDevice(views, 0));
  const std::uint64_t bytes = standin_->allocated_bytes;
  standin_->failing = "cuMemAlloc";
  ASSERT_TRUE((*engine)->renderToDevice(views, 0));
  ASSERT_TRUE((*engine)->renderToDevice({views.data(), 2}, 0));
  EXPECT_EQ(standin_->allocated_bytes, bytes);
}

TEST_F(CudaHost, UploadsATextureThatPacksShareOnce) {
  constexpr std::uint32_t kEdge = 128;
  RenderModelBuilder textured;
  const std::int32_t texture =
      textured.texture(kEdge, std::vector<std::uint32_t>(std::size_t{kEdge} * kEdge));
  const std::uint16_t material = textured.material(0, texture);
  textured.model();
  textured.quad({{{2, -1, -1}, {2, -1, 1}, {2, 1, 1}, {2, 1, -1}}}, {.material = material});
  textured.finish();
  const auto bytes_of = [&](int packs) {
    library_ = {};
    for (int n = 0; n < packs; ++n) library_.add(textured.meshes());
    const std::uint64_t before = standin_->allocated_bytes;
    const auto engine = makeEngine(library_, options_);
    EXPECT_TRUE(engine);
    return standin_->allocated_bytes - before;
  };
  const std::uint64_t one = bytes_of(1);
  EXPECT_GT(one, std::uint64_t{4} * kEdge * kEdge);
  EXPECT_LT(bytes_of(3), one + std::uint64_t{4} * kEdge * kEdge);
}

TEST_F(CudaHost, LeavesOnTheDeviceWhatItWouldRead) {
  options_.semantics = true;
  auto engine = makeEngine(library_, options_);
  ASSERT_TRUE(engine);
  const std::vector<RenderView> views(3, view_);
  const RenderImages expected = drawWithSoft(library_, options_, views);
  const auto images = (*engine)->renderToDevice(views, 0);
  ASSERT_TRUE(images);
  // The stand-in's device has the memory of the processor.
  RenderImages found = emptyImages(options_, views.size());
  std::memcpy(found.color.data(), std::bit_cast<const void*>(images->color), found.color.size());
  std::memcpy(found.depth.data(), std::bit_cast<const void*>(images->depth),
              4 * found.depth.size());
  std::memcpy(found.semantics.data(), std::bit_cast<const void*>(images->semantics),
              4 * found.semantics.size());
  EXPECT_EQ(found, expected);
  EXPECT_EQ((*engine)->statistics().instances, 3U);
  EXPECT_EQ((*engine)->statistics().triangles_drawn, 6U);
}

TEST_F(CudaHost, SaysOnWhichDeviceItLeavesImages) {
  const auto device_of = [&](const char* wish) {
    options_.device = wish;
    auto engine = makeEngine(library_, options_);
    EXPECT_TRUE(engine);
    const auto images = (*engine)->renderToDevice({&view_, 1}, 0);
    EXPECT_TRUE(images);
    return images->device;
  };
  EXPECT_EQ(device_of(""), 0);
  EXPECT_EQ(device_of("cuda:1"), 1);
  // As those number them that use the images.
  const Variable turned("CUDA_VISIBLE_DEVICES", "1,0");
  EXPECT_EQ(device_of("GPU-10111213-1415-1617-1819-1a1b1c1d1e1f"), 0);
}

/// The stand-in is loaded under the name of CUDA's driver, so this program finds it by that.
TEST_F(CudaHost, DrawsOnTheStreamThatUsesTheImages) {
  auto engine = makeEngine(library_, options_);
  ASSERT_TRUE(engine);
  const auto drawOn = [&](std::uintptr_t stream) {
    standin_->stream = stream;
    standin_->on_stream = standin_->on_others = 0;
    ASSERT_TRUE((*engine)->renderToDevice({&view_, 1}, stream));
    EXPECT_GT(standin_->on_stream, 0U) << stream;
    EXPECT_EQ(standin_->on_others, 0U) << stream;
  };
  drawOn(0x5A);
  drawOn(0);
  drawOn(0x6B);
  // Images that are read back use the default stream again.
  standin_->stream = 0;
  standin_->on_stream = standin_->on_others = 0;
  RenderImages images = emptyImages(options_, 1);
  (*engine)->begin({&view_, 1}, targetsOf(images));
  (*engine)->end();
  EXPECT_GT(standin_->on_stream, 0U);
  EXPECT_EQ(standin_->on_others, 0U);
}

TEST_F(CudaHost, IsTakenFirstOnChipsForDataCenters) {
  options_.backend = RenderBackend::kAuto;
  const BatchRenderer taken = makeRenderer(library_, options_);
  EXPECT_EQ(taken.backend(), RenderBackend::kCuda);
  EXPECT_STREQ(backendName(taken.backend()), "cuda");
  standin_->failing = "cuModuleLoadDataEx";
  EXPECT_NE(makeRenderer(library_, options_).backend(), RenderBackend::kCuda);
  standin_->failing = nullptr;
  standin_->minor = 6;
  options_.device = "software";
  EXPECT_NE(makeRenderer(library_, options_).backend(), RenderBackend::kCuda);
}

TEST_F(CudaHost, IsNotTakenUnaskedWhereItsImagesAreNotThoseOfSoft) {
  EXPECT_TRUE(render::proveCuda(options_));
  standin_->spoils = true;
  const Result<void> proven = render::proveCuda(options_);
  ASSERT_FALSE(proven);
  EXPECT_EQ(proven.error().message,
            "cuda, Stand-in A, compute capability 9.0 gives other images than the processor");
  options_.backend = RenderBackend::kAuto;
  EXPECT_NE(makeRenderer(library_, options_).backend(), RenderBackend::kCuda);
  options_.backend = RenderBackend::kCuda;
  EXPECT_EQ(makeRenderer(library_, options_).backend(), RenderBackend::kCuda);
}

TEST_F(CudaHost, DrawsThroughTheInterfaceWhatSoftDraws) {
  options_.backend = RenderBackend::kCuda;
  const std::vector<RenderView> views(2, view_);
  EXPECT_EQ(renderViews(library_, options_, views), drawWithSoft(library_, options_, views));
}

TEST_F(CudaHost, DrawsABatchOfNoViews) {
  auto engine = makeEngine(library_, options_);
  ASSERT_TRUE(engine);
  ASSERT_TRUE((*engine)->renderToDevice({}, 0));
  EXPECT_EQ((*engine)->statistics().clusters_drawn, 0U);
}

}  // namespace
}  // namespace galactic::test::cuda_host_test
