#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dataset/config/dataset_index.h"
#include "dataset/config/receptacles.h"
#include "galactic/error.h"

namespace galactic::bake {

/// What the attributes of a stage or object say that matters here; of an articulated object its
/// URDF and uniform scale.
struct TemplateAttributes {
  /// As stated; relative to DatasetTemplate::folder. Empty where nothing is stated.
  std::string render_asset;
  std::string collision_asset;
  std::string urdf;
  std::array<double, 3> scale{1, 1, 1};
  /// Directions in the asset's frame that become +Y and -Z.
  std::array<double, 3> up{0, 1, 0};
  std::array<double, 3> front{0, 0, -1};
  /// In the asset's frame after `up` and `front`, before the scale. None: the center of its box.
  /// What is stated last decides: Habitat takes it back where a layer states none.
  std::optional<std::array<double, 3>> center_of_mass;
  bool collidable = true;
  ReceptacleTexts receptacles;
};

/// The attributes of `entry`: the block's defaults, the template's own file and its layers, each
/// over what came before. Reads at most one file, `entry.config`. Fails with kIo or kInvalidInput.
[[nodiscard]] Result<TemplateAttributes> readAttributes(const DatasetTemplate& entry,
                                                        const DatasetBlock& block,
                                                        TemplateKind kind);

/// Everything stated about `entry` in the order in which it applies: defaults, file, layers.
[[nodiscard]] Result<std::vector<AttributeLayer>> layersOf(const DatasetTemplate& entry,
                                                           const DatasetBlock& block,
                                                           TemplateKind kind);

/// Where messages say that something is stated of `entry`.
[[nodiscard]] std::string placeOf(const DatasetTemplate& entry);

/// The file that `stated` means, absolute.
[[nodiscard]] std::filesystem::path fileOf(const DatasetTemplate& entry, const std::string& stated);

/// The mesh of a stage or object, absolute: that which is drawn, else that which collides, else the
/// file that the template itself is. Fails with kInvalidInput where there is none of them.
[[nodiscard]] Result<std::filesystem::path> meshFileOf(const DatasetTemplate& entry,
                                                       const TemplateAttributes& attributes);

/// The URDF of an articulated object, absolute: as stated, as found, else beside its attributes.
[[nodiscard]] std::filesystem::path urdfOf(const DatasetTemplate& entry,
                                           const TemplateAttributes& attributes);

}  // namespace galactic::bake
