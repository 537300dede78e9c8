#pragma once
#include <string>

#include "galactic/bake/source_asset.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Refuses an asset that nothing can be made of: indices out of range, a NaN or infinite vertex
/// that a placed triangle uses, a transform that is not finite or flattens its mesh, no triangle at
/// all. `where` starts the place of each error, usually the file. All errors are kInvalidInput.
[[nodiscard]] Result<void> checkAsset(const SourceAsset& asset, const std::string& where);

/// Adds a warning when the whole asset is smaller than `smallest_size` meters in all directions:
/// its unit is then in doubt. 0: never. `asset` has passed checkAsset.
void warnAboutSize(SourceAsset& asset, double smallest_size);

/// Adds a warning when a glTF scene shows clearly more floor at one level with the Z axis of its
/// file up than with its Y axis, and would be lower: scans are published so, against the standard.
/// For scenes of whose up axis nobody has said anything; `asset` has passed checkAsset.
void warnAboutUp(SourceAsset& asset);

/// Refuses a scene that is higher than any home: its unit is not the meter, and its grid would take
/// all memory there is. For scenes whose unit the user has not stated. kInvalidInput; `asset` has
/// passed checkAsset.
[[nodiscard]] Result<void> checkHeight(const SourceAsset& asset, const std::string& where);

/// A movable object that is larger than this probably has another unit, meters.
inline constexpr double kLargestObject = 3;

/// Refuses an object that is larger than kLargestObject in any direction: spheres of a few
/// millimeters would be fitted to it for minutes. For objects whose unit nobody has stated; the
/// message names a unit that gives it a likely size, 5 cm or more. kInvalidInput; `asset` has
/// passed checkAsset.
[[nodiscard]] Result<void> checkObjectSize(const SourceAsset& asset, const std::string& where);

}  // namespace galactic::bake
