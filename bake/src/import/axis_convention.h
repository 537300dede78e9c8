#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "galactic/bake/mesh_import.h"
#include "galactic/error.h"

namespace galactic::bake {

/// A fact and who states it, for example (kZ, "PLY convention").
template <class T>
struct Stated {
  T value{};
  std::string_view by;
};

/// Sources of facts, other than conventions of formats.
inline constexpr std::string_view kByFile = "file";
inline constexpr std::string_view kByUp = "`up`";
inline constexpr std::string_view kByScale = "`scale`";

/// How to interpret the coordinates of a file.
struct AxisConvention {
  Stated<UpAxis> up;
  /// Meters per unit, > 0.
  Stated<double> meters;
};

/// `stated`, with the values that the user gave in place of its own.
[[nodiscard]] AxisConvention withOverrides(AxisConvention stated, const MeshImportOptions& options);

/// Rotation to Y up and scale to meters: a proper rotation (never a mirror image) times a scale.
/// Z up becomes (x, z, -y), as in glTF and COLLADA exporters.
[[nodiscard]] Affine worldFromFile(const AxisConvention& convention);

/// Whether the file or the user states the unit.
[[nodiscard]] bool isUnitStated(const AxisConvention& convention);

/// A text for users, like "Z up (file), 0.01 m per unit (`scale`)".
[[nodiscard]] std::string describe(const AxisConvention& convention);

/// The decimal number that a file most likely states if its reader delivers `value`: 0.01, not
/// 0.009999999776.
[[nodiscard]] double shortestDecimal(float value);

/// Recovers the up axis and the unit from a matrix that a reader made of them: one of the rotations
/// of worldFromFile for +X, +Y or +Z times a positive scale. None if the matrix is not of this
/// kind.
[[nodiscard]] std::optional<AxisConvention> conventionOf(const Affine& world_from_file,
                                                         std::string_view stated_by);

}  // namespace galactic::bake
