#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "pack_tool/describe/pack_description.h"

namespace galactic::pack_tool {

/// A named value that is not the same on both sides; "none" where a side has no such value.
struct FieldDifference {
  std::string field;
  std::string a;
  std::string b;

  friend bool operator==(const FieldDifference&, const FieldDifference&) = default;
};

/// How far the values of one field may differ and still be equal. Strings have to be the same.
struct FieldTolerance {
  bool is_ignored = false;
  /// B may be less than A by any amount: an error that became smaller is no difference.
  bool is_upper_bound = false;
  /// Of numbers with a fraction, in their own unit.
  double absolute = 0;
  /// Shares of A's number.
  double share_of_fractions = 0;
  double share_of_whole_numbers = 0;
};

/// The tolerance of a field. It is named by its keys alone, "grids.spans" for "grids.0.spans".
using ToleranceOf = std::function<FieldTolerance(std::string_view keys)>;

/// Compares two JSON values leaf by leaf. A list of objects that all have a "pack", a "name", a
/// "region" or a "path", or each another "radius" or "scene", is compared by it and not by
/// position.
[[nodiscard]] std::vector<FieldDifference> compareFields(const Json& a, const Json& b,
                                                         const ToleranceOf& tolerance_of);

/// The same for one tolerance: fractions that differ by no more than `tolerance` are equal.
[[nodiscard]] std::vector<FieldDifference> compareFields(const Json& a, const Json& b,
                                                         double tolerance);

/// The order of two lists whose elements have names, for lists where it counts: none where the
/// names that both have stand in one order, else one difference, "FIELD.order". That one side lacks
/// a name is for compareFields() to tell.
[[nodiscard]] std::vector<FieldDifference> compareOrder(const std::string& field, const Json& a,
                                                        const Json& b);

/// Adds `from` behind what `to` has.
void append(std::vector<FieldDifference>& to, const std::vector<FieldDifference>& from);

}  // namespace galactic::pack_tool
