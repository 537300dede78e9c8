#pragma once
#include "pictures/image.h"

namespace galactic::pictures {

inline constexpr Rgb kPaper{255, 255, 255};
inline constexpr Rgb kInk{32, 32, 36};
inline constexpr Rgb kFaintInk{150, 150, 156};
/// Columns or heights where no sphere center may be.
inline constexpr Rgb kBlocked{44, 44, 48};
/// Heights where a sphere center may be, in a slice.
inline constexpr Rgb kFree{214, 232, 244};
/// What the grid does not cover.
inline constexpr Rgb kUncovered{190, 186, 180};

/// The color of `share` of a scale: a perceptually uniform scale (viridis) from dark violet at 0
/// over green to yellow at 1. Values outside [0, 1] are clamped, NaN counts as 0.
[[nodiscard]] Rgb scaleColor(double share);

/// `share` (0 to 1) of `over` laid on `under`.
[[nodiscard]] Rgb blend(Rgb under, Rgb over, double share);

}  // namespace galactic::pictures
