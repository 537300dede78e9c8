#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <limits>

#include "command.h"

namespace galactic::bake {
namespace {

template <class T>
std::span<const std::byte> memoryOf(const T& field) {
  return std::as_bytes(std::span(&field, 1));
}

/// The given value if it is a single text; empty otherwise.
std::string typedText(std::span<const GivenValue> given) {
  const auto& words = given.front().words;
  const auto* text = words.size() == 1 ? std::get_if<std::string>(&words.front()) : nullptr;
  return text == nullptr ? std::string() : *text;
}

bool parseWhole(std::string_view text, std::size_t& number) {
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  return problem == std::errc() && end == text.data() + text.size();
}

/// A field such as "2/8": the second of eight shards.
class ShardField final : public OptionField {
 public:
  explicit ShardField(Shard& field) : field_(field) {}
  [[nodiscard]] OptionKind kind() const override { return OptionKind::kText; }
  std::string read(std::span<const GivenValue> given) override {
    const std::string text = typedText(given);
    const std::size_t slash = text.find('/');
    const bool is_pair = slash != std::string::npos &&
                         parseWhole(std::string_view(text).substr(0, slash), field_.index) &&
                         parseWhole(std::string_view(text).substr(slash + 1), field_.count);
    if (!is_pair || field_.index < 1 || field_.index > field_.count) {
      return fmt::format("is \"{}\", expected I/N with I from 1 to N, for example 2/8", text);
    }
    --field_.index;
    return {};
  }
  [[nodiscard]] std::vector<std::string> texts() const override {
    if (field_.count == 1) return {};
    return {fmt::format("{}/{}", field_.index + 1, field_.count)};
  }
  [[nodiscard]] std::span<const std::byte> memory() const override { return memoryOf(field_); }

 private:
  Shard& field_;
};

/// A number of GiB, stored in bytes.
class GibibyteField final : public OptionField {
 public:
  explicit GibibyteField(std::uint64_t& field) : field_(field) {}
  [[nodiscard]] OptionKind kind() const override { return OptionKind::kNumber; }
  std::string read(std::span<const GivenValue> given) override {
    double gibibytes = 0;
    std::string fault =
        number(gibibytes, {.least = 0, .most = 1U << 30U, .above = true})->read(given);
    if (fault.empty()) field_ = static_cast<std::uint64_t>(gibibytes * kBytes);
    return fault;
  }
  [[nodiscard]] std::vector<std::string> texts() const override {
    if (field_ == 0) return {};
    return {fmt::format("{}", static_cast<double>(field_) / kBytes)};
  }
  [[nodiscard]] std::span<const std::byte> memory() const override { return memoryOf(field_); }

 private:
  static constexpr double kBytes = 1U << 30U;
  std::uint64_t& field_;
};

/// A switch that sets the verbosity.
class VerbosityField final : public OptionField {
 public:
  VerbosityField(Verbosity& field, Verbosity when_typed) : field_(field), when_typed_(when_typed) {}
  [[nodiscard]] OptionKind kind() const override { return OptionKind::kSwitch; }
  std::string read(std::span<const GivenValue> given) override {
    bool is_on = false;
    std::string fault = flag(is_on)->read(given);
    if (fault.empty() && is_on) field_ = when_typed_;
    return fault;
  }
  [[nodiscard]] std::vector<std::string> texts() const override {
    if (field_ != when_typed_) return {};
    return {"true"};
  }
  [[nodiscard]] std::span<const std::byte> memory() const override { return memoryOf(field_); }

 private:
  Verbosity& field_;
  Verbosity when_typed_;
};

}  // namespace

void visitOptions(ToolOptions& options, OptionVisitor& v) {
  auto& [verbosity, out, threads, report, dry_run, keep_going] = options;
  v.group("Options");
  v.option({"out", "OUT", "Pack to write, or a folder for several packs (default: NAME.pack)"},
           path(out));
  v.option({"threads", "N", "Threads; the packs do not depend on it; 0: one per processor"},
           whole(threads, {0, 4096}));
  v.option({"report", "FILE.json", "Write what was done as JSON"}, path(report));
  v.option({"dry-run", "",
            "Read and check the inputs, write no pack; exit code 3 when something is missing"},
           flag(dry_run));
  v.option({"keep-going", "", "Go on with the next input after an error"}, flag(keep_going));
  v.option({"verbose", "", "Say more"},
           std::make_unique<VerbosityField>(verbosity, Verbosity::kVerbose));
  v.option({"quiet", "", "Only errors"},
           std::make_unique<VerbosityField>(verbosity, Verbosity::kQuiet));
}

void visitOptions(ManyPacksOptions& options, OptionVisitor& v) {
  auto& [cache, no_cache, shard, memory] = options;
  v.group("Datasets, worlds from recipes");
  v.option({"cache", "DIR",
            "Folder of bakes that were done before (default: .cache beside the "
            "packs)"},
           path(cache));
  v.option({"no-cache", "", "Bake everything, and remember nothing"}, flag(no_cache));
  v.option({"shard", "I/N",
            "Bake only part I of N, and link no world; afterwards the same command without "
            "--shard links what the parts made"},
           std::make_unique<ShardField>(shard));
  v.option({"memory", "GIB",
            "GiB that bakes, and scenes with episodes, may take at the same time (default: 3/4 of "
            "the machine's)"},
           std::make_unique<GibibyteField>(memory));
}

void visitOptions(DatasetCommand& command, OptionVisitor& v) {
  auto& [jobs, list] = command;
  visitOptions(jobs, v);
  v.option({"list", "", "Print the names of the scenes, bake nothing"}, flag(list));
}

void visitOptions(EpisodeOverrides& episodes, OptionVisitor& v) {
  auto& [count, seed] = episodes;
  v.group("Episodes");
  v.option({"count", "N", "How many episodes, instead of what the recipe says"},
           whole(count, {1, 1'000'000}));
  v.option({"seed", "N", "The number from which they are drawn, instead of the recipe's"},
           whole(seed, {0, std::numeric_limits<std::uint64_t>::max()}));
}

void visitOptions(RecipeCommand& command, OptionVisitor& v) {
  auto& [data, episodes] = command;
  visitOptions(episodes, v);
  v.group("Datasets, worlds from recipes");
  v.option({"data", "DIR", "Where a recipe's files are looked for that are not beside it"},
           path(data));
}

}  // namespace galactic::bake
