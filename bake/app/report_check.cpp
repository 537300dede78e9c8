#include "report_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "support/mapped_file.h"
#include "support/printable.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// Numbers with a fraction that come out of the same computation with another compiler.
constexpr double kSameNumber = 1e-6;
constexpr const char* kTolerances = "tolerances";

constexpr std::array<std::string_view, 8> kIgnored{"seconds", "input",   "output",  "meshes",
                                                   "tool",    "version", "message", "where"};
constexpr std::array<std::string_view, 8> kUpperBounds{
    "errors",     "columns_differing", "largest_error",  "gap",
    "protrusion", "thin_points",       "guaranteed_gap", "guaranteed_protrusion"};

template <std::size_t kCount>
bool contains(const std::array<std::string_view, kCount>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Where a value stands, for people and for rules.
struct Place {
  /// "baked[0].grids[1].spans"
  std::string shown;
  /// "baked.grids.spans"
  std::string keys;
  /// Whether a key on the way is an upper bound.
  bool is_bound = false;
  /// The tolerance of the nearest key on the way that has one.
  const Json* rule = nullptr;

  [[nodiscard]] Place member(const std::string& key) const {
    const std::string dot = keys.empty() ? "" : ".";
    return {shown + dot + key, keys + dot + key, is_bound || contains(kUpperBounds, key), rule};
  }
  [[nodiscard]] Place element(std::size_t n) const {
    return {fmt::format("{}[{}]", shown, n), keys, is_bound, rule};
  }
  [[nodiscard]] std::string_view key() const {
    return std::string_view(keys).substr(keys.rfind('.') + 1);
  }
};

/// Whether `place` ends in the keys of `ending`.
bool endsIn(std::string_view place, std::string_view ending) {
  if (!place.ends_with(ending)) return false;
  return place.size() == ending.size() || place[place.size() - ending.size() - 1] == '.';
}

class Comparison {
 public:
  Comparison(const Json& golden, std::optional<double> tolerance) : tolerance_(tolerance) {
    if (golden.contains(kTolerances)) tolerances_ = golden.at(kTolerances);
  }

  void compare(const Json& wanted, const Json& found, Place place) {
    if (isIgnored(place)) return;
    if (const Json* rule = ruleOf(place)) place.rule = rule;
    if (wanted.is_number() && found.is_number()) return compareNumbers(wanted, found, place);
    if (wanted.is_object() && found.is_object()) return compareObjects(wanted, found, place);
    if (wanted.is_array() && found.is_array()) return compareLists(wanted, found, place);
    ++result_.compared;
    if (wanted != found) differ(place, textOf(found), textOf(wanted));
  }

  [[nodiscard]] ReportComparison take() { return std::move(result_); }

 private:
  /// That of the longest end; null where there is none.
  [[nodiscard]] const Json* ruleOf(const Place& place) const {
    const Json* rule = nullptr;
    std::size_t longest = 0;
    if (place.keys.empty() || !tolerances_.is_object()) return nullptr;
    for (auto one = tolerances_.begin(); one != tolerances_.end(); ++one) {
      if (one.key().size() < longest || !endsIn(place.keys, one.key())) continue;
      longest = one.key().size();
      rule = &*one;
    }
    return rule;
  }

  void compareNumbers(const Json& wanted, const Json& found, const Place& place) {
    ++result_.compared;
    const bool whole = wanted.is_number_integer() && found.is_number_integer();
    const double slack = place.rule != nullptr ? place.rule->get<double>()
                                               : tolerance_.value_or(whole ? 0.0 : kSameNumber);
    const double a = wanted.get<double>();
    const double b = found.get<double>();
    const double more = place.is_bound ? b - a : std::abs(b - a);
    if (wanted == found || more <= slack * std::abs(a)) return;
    const std::string within =
        slack > kSameNumber ? fmt::format(" within {:g} %", slack * 100) : "";
    differ(place, textOf(found),
           fmt::format("{}{}{}", place.is_bound ? "at most " : "", textOf(wanted), within));
  }

  void compareObjects(const Json& wanted, const Json& found, const Place& place) {
    for (auto one = wanted.begin(); one != wanted.end(); ++one) {
      const Place member = place.member(one.key());
      if (place.keys.empty() && one.key() == kTolerances) continue;
      const auto other = found.find(one.key());
      if (other != found.end()) {
        compare(*one, *other, member);
      } else if (!isIgnored(member)) {
        differ(member, "nothing", textOf(*one));
      }
    }
    for (auto one = found.begin(); one != found.end(); ++one) {
      const Place member = place.member(one.key());
      if (!wanted.contains(one.key()) && !isIgnored(member)) {
        differ(member, textOf(*one), "nothing");
      }
    }
  }

  void compareLists(const Json& wanted, const Json& found, const Place& place) {
    if (wanted.size() != found.size()) {
      ++result_.compared;
      differ(place, fmt::format("{} elements", found.size()), fmt::format("{}", wanted.size()));
    }
    for (std::size_t n = 0; n < std::min(wanted.size(), found.size()); ++n) {
      compare(wanted[n], found[n], place.element(n));
    }
  }

  [[nodiscard]] bool isIgnored(const Place& place) const {
    const Json* rule = ruleOf(place);
    return rule != nullptr ? rule->is_null() : contains(kIgnored, place.key());
  }

  /// A value in a line, cut where it is long.
  static std::string textOf(const Json& value) {
    constexpr std::size_t kLongest = 80;
    std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (text.size() <= kLongest) return text;
    // Not in the middle of a character.
    std::size_t end = kLongest;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0U) == 0x80U) --end;
    return text.substr(0, end) + "...";
  }

  void differ(const Place& place, std::string_view found, std::string_view wanted) {
    result_.differences.push_back(fmt::format("{}: {}, expected {}", place.shown, found, wanted));
  }

  std::optional<double> tolerance_;
  Json tolerances_;
  ReportComparison result_;
};

Result<void> checkTolerances(const fs::path& path, const Json& report) {
  if (!report.contains(kTolerances)) return {};
  const Json& tolerances = report.at(kTolerances);
  const std::string where = fmt::format("{}: {}", path.string(), kTolerances);
  if (!tolerances.is_object()) {
    return fail(ErrorCode::kInvalidInput, where, "expected an object of keys and their tolerances");
  }
  for (auto one = tolerances.begin(); one != tolerances.end(); ++one) {
    const bool good = one->is_null() || (one->is_number() && one->get<double>() >= 0);
    if (good) continue;
    return fail(ErrorCode::kInvalidInput, fmt::format("{}.{}", where, one.key()),
                "is neither a share of 0 or more (0.01 is 1 %) nor null, which ignores the key");
  }
  return {};
}

}  // namespace

Result<GoldenReport> readGoldenReport(const fs::path& path) {
  ASSIGN_OR_RETURN(const auto file, MappedFile::open(path));
  const std::string_view text(reinterpret_cast<const char*>(file.bytes().data()),
                              file.bytes().size());
  Json report = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  const bool is_report = report.is_object() && report.contains("tool") &&
                         report.at("tool") == "galactic-bake" && report.contains("baked") &&
                         report.at("baked").is_array();
  if (!is_report) {
    return fail(ErrorCode::kInvalidInput, path.string(),
                "is not a report of galactic-bake; make one with --report");
  }
  RETURN_IF_ERROR(checkTolerances(path, report));
  return GoldenReport{path, std::move(report)};
}

ReportComparison compareReports(const GoldenReport& golden, const Json& report,
                                std::optional<double> tolerance) {
  Comparison comparison(golden.report, tolerance);
  comparison.compare(golden.report, report, {});
  return comparison.take();
}

int checkReport(const GoldenReport& golden, const Json& report, const BakeCommand& command) {
  const ReportComparison result = compareReports(golden, report, command.run.tolerance);
  for (const std::string& difference : result.differences) {
    fmt::print("{}: {}\n", printable(golden.path.string()), printable(difference));
  }
  const bool same = result.differences.empty();
  if (!same) {
    fmt::print("{}: {} differences in {} values\n", printable(golden.path.string()),
               result.differences.size(), result.compared);
  } else if (command.run.verbosity != Verbosity::kQuiet) {
    fmt::print("{}: as expected in {} values\n", printable(golden.path.string()), result.compared);
  }
  return same ? kExitOk : kExitDiffers;
}

Result<std::optional<GoldenReport>> goldenOf(const BakeCommand& command) {
  if (command.run.golden_report.empty()) return std::nullopt;
  return readGoldenReport(command.run.golden_report);
}

}  // namespace galactic::bake
