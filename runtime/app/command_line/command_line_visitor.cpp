#include "command_line/command_line_visitor.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "command_line/options.h"
#include "command_line/policy_command_line.h"
#include "run/policy.h"
#include "support/text/height_text.h"
#include "support/text/range_text.h"

namespace galactic {
namespace {

/// Options that also have a letter.
constexpr std::array<std::pair<std::string_view, char>, 2> kLetters{
    {{"quiet", 'q'}, {"threads", 'j'}}};

/// What --help shows for a number: the unit in the option's explanation.
std::string_view placeholderOf(std::string_view help) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kUnits{
      {{", meters", "METERS"}, {", degrees", "DEGREES"}, {", radians", "RADIANS"}}};
  for (const auto& [unit, shown] : kUnits) {
    if (help.find(unit) != std::string_view::npos) return shown;
  }
  return "NUMBER";
}

TextCheck rangeCheck(Within<float> within) {
  return numberCheck(static_cast<double>(within.least), static_cast<double>(within.most));
}

/// Parses a whole number from 1 to kLargestImage.
std::optional<std::uint32_t> edgeOf(std::string_view text) {
  std::uint32_t edge = 0;
  const char* end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, edge);
  if (problem != std::errc() || stop != end || edge < 1 || edge > kLargestImage) return {};
  return edge;
}

/// Parses "128" or "160x120".
std::optional<std::pair<std::uint32_t, std::uint32_t>> sizeOf(std::string_view text) {
  const std::size_t cross = text.find('x');
  const auto width = edgeOf(text.substr(0, cross));
  const auto height = cross == std::string_view::npos ? width : edgeOf(text.substr(cross + 1));
  if (!width || !height) return {};
  return std::pair(*width, *height);
}

}  // namespace

std::optional<std::array<float, 3>> CommandLineVisitor::threeOf(std::string_view text, float most) {
  const auto limit = static_cast<double>(most);
  std::array<float, 3> numbers{};
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    const std::size_t end = n + 1 < numbers.size() ? text.find(',') : text.size();
    if (end == std::string_view::npos) return {};
    const std::string_view one = text.substr(0, end);
    if (!numberFault(one, -limit, limit).empty()) return {};
    std::from_chars(one.data(), one.data() + one.size(), numbers[n]);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return numbers;
}

void CommandLineVisitor::seed(std::string_view name, std::uint64_t& field, std::string_view help) {
  add(name, field, help)
      ->check(wholeCheck(0, std::numeric_limits<std::uint64_t>::max()))
      ->option_text(fmt::format("N [{}]", field))
      ->group(kPlainGroup);
}

void CommandLineVisitor::real(std::string_view name, float& field, Within<float> within,
                              std::string_view help) {
  add(name, field, help)
      ->check(rangeCheck(within))
      ->option_text(fmt::format("{} [{}]", placeholderOf(help), field));
}

void CommandLineVisitor::wish(std::string_view name, float& field, Within<float> within,
                              Shown shown, std::string_view help) {
  add(name, field, help)->check(rangeCheck(within))->option_text(shown.value);
}

void CommandLineVisitor::three(std::string_view name, std::array<float, 3>& field, float most,
                               Shown shown, std::string_view help) {
  addThree(name, field, most, help)
      ->option_text(fmt::format("{} [{}]", shown.value, fmt::join(field, ",")));
}

void CommandLineVisitor::point(std::string_view name, std::optional<std::array<float, 3>>& field,
                               float most, Shown shown, std::string_view help) {
  addThree(name, field, most, help)->option_text(shown.value);
}

void CommandLineVisitor::drawn(std::string_view name, DrawnNumber& field, const Span& within,
                               std::string_view help) {
  addDrawn(name, field, within, help)
      ->option_text(fmt::format("{}|LOW-HIGH [{}]", placeholderOf(help), drawnText(field)));
}

void CommandLineVisitor::drawn(std::string_view name, DrawnCount& field, std::uint32_t most,
                               std::string_view help) {
  addDrawn(name, field, most, help)->option_text(fmt::format("N|LOW-HIGH [{}]", drawnText(field)));
}

void CommandLineVisitor::heights(std::string_view name, std::vector<Span>& field,
                                 const Span& within, std::string_view help) {
  const auto parse = [within](const std::string& text) { return heightsFrom(text, within); };
  addParsed(name, field, parse, wantedHeights(within), help)
      ->option_text(fmt::format("H,LOW-HIGH,... [{}]", heightText(field)));
}

void CommandLineVisitor::flag(std::string_view name, const Switch& value, std::string_view help) {
  // --NAME=false must also work, because a world may have turned the switch on.
  const auto set = [value](std::int64_t times) { value.field = (times > 0) == value.when_typed; };
  app_.add_flag_function(dashed(name), set, std::string(help))
      ->check(switchCheck())
      ->group(heading_)
      ->option_text(" ");
}

void CommandLineVisitor::text(std::string_view name, std::string& field, Shown shown,
                              std::string_view help) {
  CLI::Option* option = add(name, field, help)->type_name(shown.value);
  if (!field.empty()) option->option_text(fmt::format("{} [{}]", shown.value, field));
}

void CommandLineVisitor::word(std::string_view name, std::string& field,
                              std::span<const std::string_view> words, std::string_view help) {
  add(name, field, help)
      ->check(CLI::IsMember(std::vector<std::string>(words.begin(), words.end())))
      ->option_text(fmt::format("{}", fmt::join(words, "|")));
}

void CommandLineVisitor::size(std::string_view name, DrawingOptions& drawing,
                              std::string_view help) {
  const CLI::Validator is_size(
      [](const std::string& text) {
        if (sizeOf(text)) return std::string();
        return fmt::format("found {}, expected N or WIDTHxHEIGHT, each 1 to {}", text,
                           kLargestImage);
      },
      "", "size");
  const auto set = [&drawing](const std::string& text) {
    if (const auto size = sizeOf(text)) std::tie(drawing.width, drawing.height) = *size;
  };
  addRead(name, set, help)->check(is_size)->option_text(fmt::format("N|WxH [{}]", drawing.width));
}

void CommandLineVisitor::policy(std::string_view name, std::string& field, std::string_view help) {
  const CLI::Validator is_known(
      [](const std::string& text) {
        RunOptions asked;
        asked.policy = text;
        if (!asked.replayFile().empty() || !asked.policyFile().empty()) return std::string();
        if (isGeneratedPolicy(text) || text == kScriptedPolicy) return std::string();
        return unknownPolicy(text, "random, forward, zero, scripted, FILE.pack or replay:FILE");
      },
      "", "policy");
  add(name, field, help)
      ->check(is_known)
      ->option_text(fmt::format("random|forward|zero|scripted|FILE.pack|replay:FILE [{}]", field));
}

void CommandLineVisitor::likeliest(std::string_view /*name*/, bool& field) {
  app_.option_defaults()->group(heading_);
  addSampling(app_, field);
  app_.option_defaults()->group(kPlainGroup);
}

std::string CommandLineVisitor::dashed(std::string_view name) {
  const auto* const found =
      std::ranges::find(kLetters, name, &std::pair<std::string_view, char>::first);
  return found == kLetters.end() ? fmt::format("--{}", name)
                                 : fmt::format("-{},--{}", found->second, name);
}

}  // namespace galactic
