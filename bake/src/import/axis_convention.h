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

/// Who states facts, but for conventions of formats.
inline constexpr std::string_view kByFile = "file";
inline constexpr std::string_view kByUp = "`up`";
inline constexpr std::string_view kByScale = "`scale`";

/// How the points of a file are to be read.
struct AxisConvention {
  Stated<UpAxis> up;
  /// Meters per unit, > 0.
  Stated<double> meters;
};

/// `stated` with what the user overrides put in its place.
[[nodiscard]] AxisConvention withOverrides(AxisConvention stated, const MeshImportOptions& options);

/// Rotation to Y up and scale to meters: a proper rotation (never a mirror image) times a scale.
/// Z up becomes (x, z, -y), as in glTF and COLLADA exporters.
[[nodiscard]] Affine worldFromFile(const AxisConvention& convention);

/// Whether the file or the user says what its unit is.
[[nodiscard]] bool isUnitStated(const AxisConvention& convention);

/// For people: "Z up (file), 0.01 m per unit (--scale)".
[[nodiscard]] std::string describe(const AxisConvention& convention);

/// The decimal number that a file most likely states when its reader delivers `value`: 0.01, not
/// 0.009999999776.
[[nodiscard]] double shortestDecimal(float value);

/// Up axis and unit of a matrix that a reader made from them: one of the rotations of worldFromFile
/// for +X, +Y or +Z times a positive scale. None when it is nothing of the kind.
[[nodiscard]] std::optional<AxisConvention> conventionOf(const Affine& world_from_file,
                                                         std::string_view stated_by);

}  // namespace galactic::bake
