#include "pack_tool/diff/report_diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>

#include "support/files/mapped_file.h"
#include "support/try.h"

namespace galactic::pack_tool {
namespace {

namespace fs = std::filesystem;

/// Numbers with a fraction that come out of the same computation with another compiler.
constexpr double kSameNumber = 1e-6;
constexpr const char* kTolerances = "tolerances";

constexpr std::array<std::string_view, 9> kIgnored{"seconds", "input", "output",  "meshes", "tool",
                                                   "version", "run",   "message", "where"};
constexpr std::array<std::string_view, 8> kUpperBounds{
    "errors",     "columns_differing", "largest_error",  "gap",
    "protrusion", "thin_points",       "guaranteed_gap", "guaranteed_protrusion"};

bool contains(std::span<const std::string_view> names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

/// Whether `place` ends in the keys of `ending`.
bool endsIn(std::string_view place, std::string_view ending) {
  if (!place.ends_with(ending)) return false;
  return place.size() == ending.size() || place[place.size() - ending.size() - 1] == '.';
}

/// That of the longest end; null where there is none.
const Json* ruleOf(const Json& rules, std::string_view place) {
  const Json* rule = nullptr;
  std::size_t longest = 0;
  for (auto one = rules.begin(); one != rules.end(); ++one) {
    if (one.key().size() < longest || !endsIn(place, one.key())) continue;
    longest = one.key().size();
    rule = &*one;
  }
  return rule;
}

/// What the rules of a golden report and the keys on the way to a value say about it.
FieldTolerance toleranceIn(const Json& rules, std::string_view keys, std::optional<double> share) {
  FieldTolerance tolerance{.share_of_fractions = share.value_or(kSameNumber),
                           .share_of_whole_numbers = share.value_or(0)};
  for (std::size_t end = 0; end < keys.size();) {
    const std::size_t begin = end == 0 ? 0 : end + 1;
    end = std::min(keys.find('.', begin), keys.size());
    const std::string_view key = keys.substr(begin, end - begin);
    tolerance.is_upper_bound = tolerance.is_upper_bound || contains(kUpperBounds, key);
    const Json* rule = ruleOf(rules, keys.substr(0, end));
    const bool is_ignored = rule == nullptr ? contains(kIgnored, key) : rule->is_null();
    if (is_ignored) return {.is_ignored = true};
    if (rule == nullptr) continue;
    tolerance.share_of_fractions = rule->get<double>();
    tolerance.share_of_whole_numbers = rule->get<double>();
  }
  return tolerance;
}

Result<void> checkTolerances(const fs::path& path, const Json& rules) {
  const std::string where = fmt::format("{}: {}", path.string(), kTolerances);
  if (!rules.is_object()) {
    return fail(ErrorCode::kInvalidInput, where, "expected an object of keys and their tolerances");
  }
  for (auto one = rules.begin(); one != rules.end(); ++one) {
    const bool good = one->is_null() || (one->is_number() && one->get<double>() >= 0);
    if (good) continue;
    return fail(ErrorCode::kInvalidInput, fmt::format("{}.{}", where, one.key()),
                "is neither a share of 0 or more (0.01 is 1 %) nor null, which ignores the key");
  }
  return {};
}

/// The document in `text`; discarded where it is no JSON, or deeper than any report.
Json parsed(std::string_view text) {
  constexpr int kDeepest = 64;
  bool is_too_deep = false;
  const auto keep = [&is_too_deep](int depth, Json::parse_event_t /*event*/, Json& /*value*/) {
    is_too_deep = is_too_deep || depth > kDeepest;
    return !is_too_deep;
  };
  Json json = Json::parse(text, keep, /*allow_exceptions=*/false);
  return is_too_deep ? Json(Json::value_t::discarded) : json;
}

Result<Json> readReport(const fs::path& path) {
  ASSIGN_OR_RETURN(const auto file, MappedFile::open(path));
  Json report = parsed({reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()});
  const bool is_report = report.is_object() && report.contains("tool") &&
                         report.at("tool") == "galactic-bake" && report.contains("baked") &&
                         report.at("baked").is_array();
  if (is_report) return report;
  return fail(ErrorCode::kInvalidInput, path.string(),
              "is not a report of galactic-bake; make one with --report");
}

}  // namespace

bool isReport(const fs::path& path) { return path.extension() == ".json"; }

Result<PackDifference> compareReports(const fs::path& a, const fs::path& b,
                                      std::optional<double> share) {
  ASSIGN_OR_RETURN(auto golden, readReport(a));
  ASSIGN_OR_RETURN(auto report, readReport(b));
  const Json rules = golden.value(kTolerances, Json::object());
  RETURN_IF_ERROR(checkTolerances(a, rules));
  golden.erase(kTolerances);
  report.erase(kTolerances);
  PackDifference difference;
  difference.a = a.string();
  difference.b = b.string();
  difference.identical = golden == report;
  difference.content = compareFields(golden, report, [&rules, share](std::string_view keys) {
    return toleranceIn(rules, keys, share);
  });
  return difference;
}

}  // namespace galactic::pack_tool
