#pragma once
#include <string>
#include <utility>
#include <vector>

#include "galactic/bake/jobs.h"
#include "galactic/bake/option_field.h"

namespace galactic::test {

/// An option as a visitor tells it.
struct WalkedOption {
  std::string name;
  bake::OptionKind kind = bake::OptionKind::kText;
  bool repeats = false;
};

/// All options that the visitor of `options` names, in its order.
template <class Options>
std::vector<WalkedOption> walk(Options options) {
  class Walker final : public bake::OptionVisitor {
   public:
    using OptionVisitor::option;
    void option(const bake::OptionInfo& info, bake::OptionField& field) override {
      options.push_back({std::string(info.name), field.kind(), field.repeats()});
    }
    std::vector<WalkedOption> options;
  };
  Walker walker;
  visitOptions(options, walker);
  return walker.options;
}

/// Values of all sorts: for each option there is one that it takes and that is not its default.
inline const std::vector<std::string>& candidateValues() {
  static const std::vector<std::string> values{
      "true",   "7",       "0.25", "0.01",  "16",        "0.05,0.5",
      "1,2,3",  "a=b",     "1/2",  "x",     "-z",        "cell",
      "embree", "all",     "min",  "tight", "bc1",       "train",
      "found",  "upright", "each", "skip",  "some/file", "1,0,0,0,0,1,0,0,0,0,1,0.5"};
  return values;
}

/// One option that is given once, as on a command line.
inline std::vector<bake::GivenOption> given(const std::string& name, const std::string& value) {
  return {{.name = name, .values = {{.name = {}, .words = {value}}}, .place = "--" + name}};
}

}  // namespace galactic::test
