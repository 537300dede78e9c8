// The PTX that the library carries: its kernels, their blocks and their shared memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <tuple>

#include "render/cuda/kernel_image.h"
#include "render/cuda/kernels/view_slice.h"
#include "support/program_run.h"
#include "support/scratch_folder.h"

namespace galactic::test::cuda_kernels_test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

/// Whose kernels: those that the library carries, or those that nvcc makes of the same source.
enum class Made { kInLibrary, kByNvcc };

class KernelText : public testing::Test {
 protected:
  void read(Made made) {
    if (made == Made::kInLibrary) {
      if (render::cuda::kernelImage() == nullptr) GTEST_SKIP() << "built without the kernels";
      text_ = render::cuda::kernelImage();
      return;
    }
    const std::string path = GALACTIC_NVCC_PTX;
    if (path.empty()) GTEST_SKIP() << "no nvcc on this machine; NVIDIA's toolkit has it";
    std::ifstream file(path, std::ios::binary);
    text_.assign(std::istreambuf_iterator<char>(file), {});
    ASSERT_FALSE(text_.empty()) << path;
  }

  /// A kernel from its name to the end of its body.
  [[nodiscard]] std::string bodyOf(const std::string& name) const {
    const std::size_t begin = text_.find(".entry " + name + "(");
    return begin == std::string::npos ? "" : text_.substr(begin, text_.find("\n}", begin) - begin);
  }

  std::string text_;
};

class CudaKernels : public KernelText, public testing::WithParamInterface<Made> {
 protected:
  void SetUp() override { read(GetParam()); }
};

std::string nameOf(Made made) { return made == Made::kInLibrary ? "InLibrary" : "ByNvcc"; }

INSTANTIATE_TEST_SUITE_P(Made, CudaKernels, testing::Values(Made::kInLibrary, Made::kByNvcc),
                         [](const auto& one) { return nameOf(one.param); });

TEST_P(CudaKernels, AreForAnyDeviceFromTheFirstThatTheirCompilerKnows) {
  // clang 14 knows 7.0, nvcc of CUDA 13 begins at 7.5.
  EXPECT_THAT(
      text_, ContainsRegex(GetParam() == Made::kByNvcc ? "\\.target sm_75" : "\\.target sm_7[05]"));
  EXPECT_THAT(text_, HasSubstr(".address_size 64"));
}

TEST_P(CudaKernels, AreAllThereWithTheBlocksThatAreLaunched) {
  for (const char* name : render::cuda::kKernelNames) {
    const std::string body = bodyOf(name);
    ASSERT_FALSE(body.empty()) << name;
    EXPECT_THAT(body, HasSubstr(".maxntid " + std::to_string(render::cuda::kBlockThreads) + ","));
    EXPECT_THAT(body, HasSubstr(".minnctapersm " + std::to_string(render::cuda::kBlocksAtOnce)));
  }
}

TEST_P(CudaKernels, RoundAsTheProcessorDoes) {
  for (const char* other : {"fma.rn", "mad.rn.f32", ".ftz", ".approx", "div.full"}) {
    EXPECT_THAT(text_, Not(HasSubstr(other)));
  }
}

TEST_P(CudaKernels, NeedNoMoreSharedMemoryThanBlocksOfAllDevicesHave) {
  // 48 KB without asking; at 16 KB, four blocks fit on every multiprocessor from sm_70 on.
  constexpr std::uint64_t kMost = std::uint64_t{16} * 1024;
  // Their names say whose they are, whether they are declared in the kernel or outside of it.
  const std::regex shared(R"(\.shared [^\n]* (\w+)\[(\d+)\];)");
  std::map<std::string, std::uint64_t> bytes;
  std::size_t found = 0;
  for (std::sregex_iterator one(text_.begin(), text_.end(), shared), end; one != end; ++one) {
    for (const char* name : render::cuda::kKernelNames) {
      if ((*one)[1].str().find(name) == std::string::npos) continue;
      bytes[name] += std::stoull((*one)[2]);
      ++found;
    }
  }
  for (const auto& [name, sum] : bytes) EXPECT_LE(sum, kMost) << name;
  EXPECT_EQ(found, 3U);
}

/// What ptxas says of a kernel that it has assembled.
struct Assembled {
  std::uint32_t registers = 0;
  std::uint32_t shared_bytes = 0;
  /// By the kernel itself, and with the functions that it calls.
  std::uint32_t spilled_bytes = 0;
  std::uint32_t spilled_in_all = 0;
};

/// By kernel. Its lines: a kernel's name; the name of it and of each function that it calls, and
/// what that spills; what it uses.
std::map<std::string, Assembled> assembledKernels(const std::string& report) {
  const std::regex name("Compiling entry function '(\\w+)'");
  const std::regex function("Function properties for (\\w+)");
  const std::regex spills("(\\d+) bytes spill stores");
  const std::regex uses("Used (\\d+) registers");
  const std::regex shared("(\\d+) bytes smem");
  std::map<std::string, Assembled> kernels;
  Assembled* current = nullptr;
  bool own = false;
  const auto number = [](const std::smatch& match) {
    return static_cast<std::uint32_t>(std::stoul(match[1]));
  };
  std::istringstream lines(report);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_search(line, match, name)) current = &kernels[match[1]];
    if (current == nullptr) continue;
    if (std::regex_search(line, match, function)) own = kernels.contains(match[1]);
    if (std::regex_search(line, match, spills)) {
      current->spilled_in_all += number(match);
      if (own) current->spilled_bytes += number(match);
    }
    if (std::regex_search(line, match, uses)) current->registers = number(match);
    if (std::regex_search(line, match, shared)) current->shared_bytes = number(match);
  }
  return kernels;
}

/// Whose kernels, and a compute capability as ptxas names it.
class AssembledKernels : public KernelText,
                         public testing::WithParamInterface<std::tuple<Made, const char*>> {
 protected:
  void SetUp() override { read(std::get<0>(GetParam())); }
};

TEST_P(AssembledKernels, FitFourBlocksOnEveryMultiprocessor) {
  const std::string ptxas = GALACTIC_PTXAS;
  const char* const arch = std::get<1>(GetParam());
  if (text_.find(".target sm_75") != std::string::npos && std::string(arch) == "sm_70") {
    GTEST_SKIP() << "nvcc's kernels are for compute capability 7.5 and more";
  }
  if (ptxas.empty()) GTEST_SKIP() << "no ptxas on this machine; NVIDIA's toolkit has it";
  const ScratchFolder folder;
  const std::string source = folder.write("device.ptx", text_).string();
  const ProgramRun run = runProgram(
      ptxas, folder.path(), {"-v", std::string("-arch=") + arch, source, "-o", "device.cubin"});
  if (run.err.find("is not defined for option 'gpu-name'") != std::string::npos) {
    GTEST_SKIP() << "this ptxas does not know " << arch;
  }
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto kernels = assembledKernels(run.err + run.out);
  // Of a multiprocessor; the least shared memory is that of 7.5.
  constexpr std::uint32_t kRegisters = 65536;
  constexpr std::uint32_t kShared = 64 * 1024;
  constexpr std::uint32_t kBlocks = 4;
  // What is spilled goes through the first cache; this much in a kernel of thousands of
  // instructions does not show. Functions of their own do what few clusters need.
  constexpr std::uint32_t kMostSpilled = 128;
  constexpr std::uint32_t kMostSpilledInAll = 640;
  for (const char* name : render::cuda::kKernelNames) {
    ASSERT_TRUE(kernels.contains(name)) << name;
    const Assembled& kernel = kernels.at(name);
    EXPECT_GT(kernel.registers, 0U) << name;
    EXPECT_LE(kernel.registers * render::cuda::kBlockThreads * kBlocks, kRegisters) << name;
    EXPECT_LE(kernel.shared_bytes * kBlocks, kShared) << name;
    EXPECT_LE(kernel.spilled_bytes, kMostSpilled) << name;
    EXPECT_LE(kernel.spilled_in_all, kMostSpilledInAll) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(
    For, AssembledKernels,
    testing::Combine(testing::Values(Made::kInLibrary, Made::kByNvcc),
                     testing::Values("sm_70", "sm_75", "sm_80", "sm_90", "sm_100")),
    [](const auto& one) { return nameOf(std::get<0>(one.param)) + "_" + std::get<1>(one.param); });

}  // namespace
}  // namespace galactic::test::cuda_kernels_test
