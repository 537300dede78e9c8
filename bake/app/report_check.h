#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "galactic/error.h"
#include "report.h"

namespace galactic::bake {

/// A report that a bake is compared with: one that --report wrote, with "tolerances" added by hand
/// where wanted.
struct GoldenReport {
  std::filesystem::path path;
  Json report;
};

/// Fails with kIo where it cannot be read, and with kInvalidInput where it is not a report of
/// galactic-bake or its tolerances are none.
[[nodiscard]] Result<GoldenReport> readGoldenReport(const std::filesystem::path& path);

/// That of the command; none where it wants no comparison.
[[nodiscard]] Result<std::optional<GoldenReport>> goldenOf(const BakeCommand& command);

/// What a comparison found.
struct ReportComparison {
  /// How many values were compared.
  std::size_t compared = 0;
  /// One sentence each: "baked[0].spans: 120, expected 118", in the order of the golden report.
  std::vector<std::string> differences;
};

/// Compares `report` with `golden`, value by value.
/// - Times, paths, the tool and its version are ignored: the keys "seconds", "input", "output",
///   "meshes", "tool", "version", and "message" and "where" of failures.
/// - Errors are upper bounds: "errors", "columns_differing", "largest_error", "gap", "protrusion",
///   "guaranteed_gap", "guaranteed_protrusion", "thin_points". Less is no difference.
/// - Other whole numbers, texts and lists have to be the same; numbers with a fraction to within
///   1e-6 of themselves.
/// "tolerances" of the golden report maps a key, or the end of a path without indices
/// ("grids.spans"), to the share by which numbers there and in it may differ (for errors: be
/// larger), or to null: ignored. The longest end counts, and what is nearer to the number.
/// `tolerance` is for all other numbers.
[[nodiscard]] ReportComparison compareReports(const GoldenReport& golden, const Json& report,
                                              std::optional<double> tolerance);

/// Compares, prints each difference, or one line that there is none unless `verbosity` is kQuiet;
/// kExitDiffers or kExitOk.
[[nodiscard]] int checkReport(const GoldenReport& golden, const Json& report,
                              const BakeCommand& command);

}  // namespace galactic::bake
