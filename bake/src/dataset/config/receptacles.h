#pragma once
#include <map>
#include <string>
#include <vector>

#include "dataset/config/template_list.h"
#include "galactic/bake/episode_set_import.h"
#include "galactic/bake/source_asset.h"
#include "json/json_reader.h"

namespace galactic::bake {

/// Annotations of receptacles as files state them, by key, for example "receptacle_aabb_top"; not
/// read yet. `file` and `place` are where a key was stated last.
using ReceptacleTexts = std::map<std::string, AttributeLayer>;

/// Takes the members of "user_defined" in `owner`, which stands in `file`, whose keys begin with
/// "receptacle_", each over what was stated before. Whatever else is there is none of ours.
void collectReceptacles(const std::string& file, const JsonNode& owner, ReceptacleTexts& stated);

/// The annotations of `more` over those in `stated`.
void addStated(const ReceptacleTexts& more, ReceptacleTexts& stated);

/// A link of furniture, for annotations that name one.
struct ReceptacleLink {
  std::string name;
  Affine world_from_link{};
};

/// What carries receptacles.
struct ReceptacleParent {
  enum class Kind {
    kPlace,      ///< A stage or scene: a box may be turned.
    kObject,     ///< A rigid object.
    kFurniture,  ///< A URDF: each box belongs to a link.
  };
  Kind kind = Kind::kPlace;
  /// Of the instance; empty for stage and scene.
  std::string name{};
  /// From the frame in which the boxes are stated; of an object that of its mesh. Not for
  /// kFurniture.
  Affine world_from_parent{};
  /// Of kFurniture only.
  std::vector<ReceptacleLink> links{};
};

/// Something wrong with an annotation.
struct ReceptacleWarning {
  std::string file;
  /// Begins with the place in the file.
  std::string message;
};

/// What became of the annotations of one parent.
struct PlacedReceptacles {
  std::vector<SupportRegion> regions;
  std::vector<ReceptacleWarning> warnings;
};

/// The boxes that are stated for `parent`, in the world, by ascending key. As in Habitat,
/// `position` is the box's center and `scale` its half extents, of either sign. Boxes whose `up`
/// does not point upwards in the world hold nothing and are left out. What is malformed is left out
/// with a warning; so are receptacles made of meshes, all of a file with one. Source: habitat-lab,
/// datasets/rearrange/samplers/receptacle.py.
[[nodiscard]] PlacedReceptacles placeReceptacles(const ReceptacleTexts& stated,
                                                 const ReceptacleParent& parent);

}  // namespace galactic::bake
