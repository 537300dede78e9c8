// The PTX that the library carries: its kernels, their blocks and their shared memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <regex>
#include <string>

#include "render/cuda/kernel_image.h"
#include "render/cuda/kernels/round.h"

namespace galactic::test::cuda_kernels_test {
namespace {

using testing::HasSubstr;
using testing::Not;

class CudaKernels : public testing::Test {
 protected:
  void SetUp() override {
    if (render::cuda::kernelImage() == nullptr) GTEST_SKIP() << "built without clang";
    text_ = render::cuda::kernelImage();
  }

  /// A kernel from its name to the end of its body.
  [[nodiscard]] std::string bodyOf(const std::string& name) const {
    const std::size_t begin = text_.find(".entry " + name + "(");
    return begin == std::string::npos ? "" : text_.substr(begin, text_.find("\n}", begin) - begin);
  }

  std::string text_;
};

TEST_F(CudaKernels, AreForAnyDeviceFromCapabilitySevenOn) {
  EXPECT_THAT(text_, HasSubstr(".target sm_70"));
  EXPECT_THAT(text_, HasSubstr(".address_size 64"));
}

TEST_F(CudaKernels, AreAllThereWithTheBlocksThatAreLaunched) {
  for (const char* name : render::cuda::kKernelNames) {
    const std::string body = bodyOf(name);
    ASSERT_FALSE(body.empty()) << name;
    EXPECT_THAT(body, HasSubstr(".maxntid " + std::to_string(render::cuda::kBlockThreads) + ","));
  }
}

TEST_F(CudaKernels, RoundAsTheProcessorDoes) {
  for (const char* other : {"fma.rn", "mad.rn.f32", ".ftz", ".approx", "div.full"}) {
    EXPECT_THAT(text_, Not(HasSubstr(other)));
  }
}

TEST_F(CudaKernels, NeedNoMoreSharedMemoryThanBlocksOfAllDevicesHave) {
  // 48 KB without asking; at 16 KB, four blocks fit on every multiprocessor from sm_70 on.
  constexpr std::uint64_t kMost = std::uint64_t{16} * 1024;
  const std::regex shared(R"(\.shared [^\n]*\[(\d+)\];)");
  std::size_t found = 0;
  for (const char* name : render::cuda::kKernelNames) {
    const std::string body = bodyOf(name);
    std::uint64_t bytes = 0;
    for (std::sregex_iterator one(body.begin(), body.end(), shared), end; one != end; ++one) {
      bytes += std::stoull((*one)[1]);
      ++found;
    }
    EXPECT_LE(bytes, kMost) << name;
  }
  EXPECT_EQ(found, 2U);
}

}  // namespace
}  // namespace galactic::test::cuda_kernels_test
