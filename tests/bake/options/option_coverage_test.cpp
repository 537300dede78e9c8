// Every field of every options struct is an option or said to be none.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "bake/options/option_walk.h"
#include "galactic/bake/job_lists.h"

namespace galactic::test::option_coverage_test {
namespace {

/// The bytes of a struct that its visitor names.
class Coverage final : public bake::OptionVisitor {
 public:
  explicit Coverage(std::span<const std::byte> whole) : whole_(whole), named_(whole.size()) {}

  using OptionVisitor::option;
  void option(const bake::OptionInfo& /*info*/, bake::OptionField& field) override {
    mark(field.memory());
  }
  void internal(std::span<const std::byte> memory) override { mark(memory); }

  /// The longest run of bytes that nobody names: padding is shorter than what it aligns.
  [[nodiscard]] std::size_t longestGap() const {
    std::size_t longest = 0;
    std::size_t gap = 0;
    for (const bool is_named : named_) {
      gap = is_named ? 0 : gap + 1;
      longest = std::max(longest, gap);
    }
    return longest;
  }

 private:
  void mark(std::span<const std::byte> memory) {
    if (memory.empty()) return;
    ASSERT_GE(memory.data(), whole_.data());
    const auto begin = static_cast<std::size_t>(memory.data() - whole_.data());
    ASSERT_LE(begin + memory.size(), whole_.size());
    std::fill_n(named_.begin() + static_cast<std::ptrdiff_t>(begin), memory.size(), true);
  }

  std::span<const std::byte> whole_;
  std::vector<bool> named_;
};

template <class Options>
void expectCovered() {
  Options options;
  Coverage coverage(std::as_bytes(std::span(&options, 1)));
  visitOptions(options, coverage);
  EXPECT_LT(coverage.longestGap(), alignof(std::max_align_t) / 2)
      << "a field of " << typeid(Options).name() << " is neither an option nor an internal";
}

TEST(OptionCoverage, NamesEveryFieldOfEveryKindOfJob) {
  expectCovered<bake::SceneJob>();
  expectCovered<bake::ObjectJob>();
  expectCovered<bake::RobotJob>();
  expectCovered<bake::EpisodeImportJob>();
  expectCovered<bake::EpisodeGenerationJob>();
  expectCovered<bake::WorldJob>();
  expectCovered<bake::DatasetJobs>();
}

TEST(OptionCoverage, SeesAFieldThatIsLeftOut) {
  struct Two {
    double named = 0;
    double forgotten = 0;
  } two;
  Coverage coverage(std::as_bytes(std::span(&two, 1)));
  coverage.internals(two.named);
  EXPECT_EQ(coverage.longestGap(), sizeof(double));
}

TEST(OptionCoverage, NamesNoOptionOfAKindTwice) {
  for (const auto& options : {walk(bake::SceneJob{}), walk(bake::ObjectJob{}),
                              walk(bake::RobotJob{}), walk(bake::EpisodeImportJob{}),
                              walk(bake::EpisodeGenerationJob{}), walk(bake::DatasetJobs{})}) {
    EXPECT_GT(options.size(), 4U);
    std::set<std::string> names;
    for (const WalkedOption& option : options) EXPECT_TRUE(names.insert(option.name).second);
  }
}

}  // namespace
}  // namespace galactic::test::option_coverage_test
