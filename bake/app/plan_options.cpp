#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <map>
#include <string_view>
#include <system_error>

#include "option_groups.h"
#include "option_values.h"

namespace galactic::bake {
namespace {

const std::map<std::string, MissingPolicy>& policyNames() {
  static const std::map<std::string, MissingPolicy> names{{"fail", MissingPolicy::kFail},
                                                          {"skip", MissingPolicy::kSkip},
                                                          {"without", MissingPolicy::kWithout}};
  return names;
}

bool parseWhole(std::string_view text, std::size_t& number) {
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  return problem == std::errc() && end == text.data() + text.size();
}

/// "2/8": the second of eight.
Result<Shard> parseShard(const std::string& text) {
  const std::size_t slash = text.find('/');
  Shard shard;
  const bool is_pair = slash != std::string::npos &&
                       parseWhole(std::string_view(text).substr(0, slash), shard.index) &&
                       parseWhole(std::string_view(text).substr(slash + 1), shard.count);
  if (!is_pair || shard.index < 1 || shard.index > shard.count) {
    return fail(ErrorCode::kInvalidInput, "--shard",
                fmt::format("is \"{}\", I/N is wanted with I from 1 to N, for example 2/8", text));
  }
  --shard.index;
  return shard;
}

/// Three quarters of what the machine has.
std::uint64_t mostOfMemory() {
  const auto pages = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES));
  const auto page_bytes = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return pages / 4 * 3 * page_bytes;
}

}  // namespace

void PlannedOptions::addDatasetTo(CLI::App& app, BakeCommand& command) {
  app.add_option("--scenes", command.dataset.scenes,
                 "Only scenes whose names fit a pattern with * and ? (may be repeated)")
      ->type_name("PATTERN")
      ->allow_extra_args(false);
  app.add_option("--missing", command.dataset.missing,
                 "A scene of which something lacks: an error, left out, or baked without "
                 "(default: without)")
      ->transform(CLI::CheckedTransformer(policyNames()))
      ->option_text("fail|skip|without");
  app.add_flag("--list", command.dataset.list, "Print the names of the scenes, bake nothing");
}

void PlannedOptions::addTo(CLI::App& app, BakeCommand& command) {
  app.add_option("--data", command.plan.data,
                 "Where a recipe's files are looked for that are not beside it")
      ->type_name("DIR");
  app.add_option("--cache", command.plan.cache,
                 "Folder of bakes that were done before (default: .cache beside the packs)")
      ->type_name("DIR");
  app.add_flag("--no-cache", command.plan.no_cache, "Bake everything, and remember nothing");
  app.add_option("--shard", shard_,
                 "Bake only part I of N, and link no world; afterwards the same command without "
                 "--shard links what the parts made")
      ->type_name("I/N");
  app.add_option("--memory", memory_,
                 "GiB that bakes at the same time may take (default: 3/4 of the machine's)")
      ->type_name("GIB");
}

Result<void> PlannedOptions::understand(BakeCommand& command) const {
  command.plan.memory = mostOfMemory();
  if (!memory_.empty()) {
    const auto gibibytes = parsePositive(memory_, "--memory");
    if (!gibibytes) return tl::unexpected(gibibytes.error());
    command.plan.memory = static_cast<std::uint64_t>(*gibibytes * (1U << 30U));
  }
  if (!shard_.empty()) {
    const auto shard = parseShard(shard_);
    if (!shard) return tl::unexpected(shard.error());
    command.plan.shard = *shard;
  }
  if (command.plan.no_cache && !command.plan.cache.empty()) {
    return fail(ErrorCode::kInvalidInput, "--no-cache", "does not go with --cache; give one");
  }
  return {};
}

}  // namespace galactic::bake
