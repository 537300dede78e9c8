// The PTX that the library carries: its kernels, their blocks and their shared memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <regex>
#include <sstream>
#include <string>

#include "render/cuda/kernel_image.h"
#include "render/cuda/kernels/view_slice.h"
#include "support/program_run.h"
#include "support/scratch_folder.h"

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

/// What ptxas says of a kernel that it has assembled.
struct Assembled {
  std::uint32_t registers = 0;
  std::uint32_t shared_bytes = 0;
  std::uint32_t spilled_bytes = 0;
};

/// By kernel. Its lines: a kernel's name, what it spills, what it uses.
std::map<std::string, Assembled> assembledKernels(const std::string& report) {
  const std::regex name("Compiling entry function '(\\w+)'");
  const std::regex spills("(\\d+) bytes spill stores");
  const std::regex uses("Used (\\d+) registers");
  const std::regex shared("(\\d+) bytes smem");
  std::map<std::string, Assembled> kernels;
  Assembled* current = nullptr;
  const auto number = [](const std::smatch& match) {
    return static_cast<std::uint32_t>(std::stoul(match[1]));
  };
  std::istringstream lines(report);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_search(line, match, name)) current = &kernels[match[1]];
    if (current == nullptr) continue;
    if (std::regex_search(line, match, spills)) current->spilled_bytes += number(match);
    if (std::regex_search(line, match, uses)) current->registers = number(match);
    if (std::regex_search(line, match, shared)) current->shared_bytes = number(match);
  }
  return kernels;
}

/// Compute capabilities, as ptxas names them.
class AssembledKernels : public CudaKernels, public testing::WithParamInterface<const char*> {};

TEST_P(AssembledKernels, FitFourBlocksOnEveryMultiprocessor) {
  const std::string ptxas = GALACTIC_PTXAS;
  if (ptxas.empty()) GTEST_SKIP() << "no ptxas on this machine; NVIDIA's toolkit has it";
  const ScratchFolder folder;
  const std::string source = folder.write("device.ptx", text_).string();
  const ProgramRun run =
      runProgram(ptxas, folder.path(),
                 {"-v", std::string("-arch=") + GetParam(), source, "-o", "device.cubin"});
  if (run.err.find("is not defined for option 'gpu-name'") != std::string::npos) {
    GTEST_SKIP() << "this ptxas does not know " << GetParam();
  }
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto kernels = assembledKernels(run.err + run.out);
  // Of a multiprocessor; the least shared memory is that of 7.5.
  constexpr std::uint32_t kRegisters = 65536;
  constexpr std::uint32_t kShared = 64 * 1024;
  constexpr std::uint32_t kBlocks = 4;
  // What is spilled goes through the first cache; this much in a kernel of thousands of
  // instructions does not show.
  constexpr std::uint32_t kMostSpilled = 256;
  for (const char* name : render::cuda::kKernelNames) {
    ASSERT_TRUE(kernels.contains(name)) << name;
    const Assembled& kernel = kernels.at(name);
    EXPECT_GT(kernel.registers, 0U) << name;
    EXPECT_LE(kernel.registers * render::cuda::kBlockThreads * kBlocks, kRegisters) << name;
    EXPECT_LE(kernel.shared_bytes * kBlocks, kShared) << name;
    EXPECT_LE(kernel.spilled_bytes, kMostSpilled) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(For, AssembledKernels,
                         testing::Values("sm_70", "sm_75", "sm_80", "sm_90", "sm_100"),
                         [](const auto& one) { return std::string(one.param); });

}  // namespace
}  // namespace galactic::test::cuda_kernels_test
