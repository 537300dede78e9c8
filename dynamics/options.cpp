#include "dynamics/options.h"

#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace galactic::dynamics {
namespace {

class Lister {
 public:
  template <class T, std::size_t N>
  void choice(std::string_view name, T field, const std::array<std::string_view, N>& names,
              std::string_view /*help*/) {
    add(name, std::string(names[static_cast<std::size_t>(field)]), true);
  }
  void real(std::string_view name, double field, Within<double> /*range*/,
            std::string_view /*help*/) {
    add(name, fmt::format("{}", field));
  }
  void whole(std::string_view name, std::uint64_t field, Within<std::uint64_t> /*range*/,
             std::string_view /*help*/) {
    add(name, fmt::format("{}", field));
  }
  void sampling(bool is_deterministic) {
    add("deterministic", is_deterministic ? "true" : "false");
  }
  void task(std::string_view /*name*/, const std::vector<OptionText>& field,
            std::string_view /*help*/) {
    texts.insert(texts.end(), field.begin(), field.end());
  }

  std::vector<OptionText> texts;

 private:
  void add(std::string_view name, std::string value, bool is_word = false) {
    texts.push_back({std::string(name), std::move(value), is_word});
  }
};

template <class Options>
std::vector<OptionText> listed(Options options) {
  Lister lister;
  visitOptions(options, lister);
  return lister.texts;
}

}  // namespace

std::vector<OptionText> listOptions(const WorldOptions& options) { return listed(options); }

std::vector<OptionText> listOptions(const LoopOptions& options) { return listed(options); }

}  // namespace galactic::dynamics
