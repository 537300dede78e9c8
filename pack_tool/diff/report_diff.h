#pragma once
#include <filesystem>
#include <optional>

#include "galactic/error.h"
#include "pack_tool/diff/diff_text.h"

namespace galactic::pack_tool {

/// Whether a file is compared as a report of galactic-bake and not as a pack: its name says so.
[[nodiscard]] bool isReport(const std::filesystem::path& path);

/// Compares two reports of galactic-bake, `a` the golden one, value by value.
/// - Times, paths, the tool and its version are ignored: the keys "seconds", "input", "output",
///   "meshes", "tool", "version", "run", and "message" and "where" of failures.
/// - Errors are upper bounds: "errors", "columns_differing", "largest_error", "gap", "protrusion",
///   "guaranteed_gap", "guaranteed_protrusion", "thin_points". Less is no difference.
/// - Other whole numbers, strings and lists have to be the same; numbers with a fraction to within
///   1e-6 of themselves.
/// "tolerances" of the golden report maps a key, or the end of a path without indices
/// ("grids.spans"), to the share by which numbers there and in it may differ (for errors: be
/// larger), or to null: ignored. The longest end counts, and what is nearer to the number.
/// `share` is for all other numbers.
/// Fails with kIo where a report cannot be read, and with kInvalidInput where it is not one of
/// galactic-bake or the golden one has tolerances of another form.
[[nodiscard]] Result<PackDifference> compareReports(const std::filesystem::path& a,
                                                    const std::filesystem::path& b,
                                                    std::optional<double> share);

}  // namespace galactic::pack_tool
