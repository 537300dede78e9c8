#pragma once
#include <string>

#include "galactic/bake/source_asset.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Refuses an asset that nothing can be made of: with indices out of range, a NaN or infinite
/// vertex that a placed triangle uses, a transform that is not finite or flattens its mesh, or no
/// triangle at all. The place of each error begins with `where`, usually the file. All errors are
/// kInvalidInput.
[[nodiscard]] Result<void> checkAsset(const SourceAsset& asset, const std::string& where);

/// Adds a warning if the whole asset is smaller than `smallest_size` meters in all directions: its
/// unit is then in doubt. Never warns if `smallest_size` is 0. `asset` must have passed checkAsset.
void warnAboutSize(SourceAsset& asset, double smallest_size);

/// Adds a warning if a glTF scene has clearly more floor at one level, and would be lower, with the
/// Z axis of its file up than with its Y axis: some scans are published like this, against the
/// standard. For scenes whose up axis nobody has stated; `asset` must have passed checkAsset.
void warnAboutUp(SourceAsset& asset);

/// Refuses a scene that is higher than any home: its unit is not the meter, and its grid would take
/// all available memory. For scenes whose unit the user has not stated. Fails with kInvalidInput;
/// `asset` must have passed checkAsset.
[[nodiscard]] Result<void> checkHeight(const SourceAsset& asset, const std::string& where);

/// Meters; a movable object that is larger than this probably has another unit.
inline constexpr double kLargestObject = 3;

/// Refuses an object that is larger than kLargestObject in any direction: fitting spheres of a few
/// millimeters to it would take minutes. For objects whose unit nobody has stated; the message
/// names a unit that gives the object a likely size, 5 cm or more. Fails with kInvalidInput;
/// `asset` must have passed checkAsset.
[[nodiscard]] Result<void> checkObjectSize(const SourceAsset& asset, const std::string& where);

}  // namespace galactic::bake
