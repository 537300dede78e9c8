#include "dataset/config/template_attributes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "json/json_reader.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxFileBytes = std::size_t{64} << 20U;
/// Meters; more is checked when the scene is baked, which cannot name the object.
constexpr double kFarthest = 1e6;
constexpr double kLargestScale = 1e4;
constexpr double kLargestId = 2e9;

using Triple = std::array<double, 3>;

double dotOf(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Reads one layer over `attributes`.
class LayerReader {
 public:
  LayerReader(const AttributeLayer& layer, TemplateAttributes& attributes)
      : json_(layer.file), root_{&layer.json, layer.place}, attributes_(attributes) {}

  Result<void> read(TemplateKind kind) {
    if (!root_.json->is_object()) json_.error(placeOfRoot(), "expected an object");
    if (kind == TemplateKind::kArticulated) {
      readArticulated();
    } else {
      readRigid();
    }
    if (json_.failed()) return json_.failure();
    collectReceptacles(json_.file(), root_, attributes_.receptacles);
    return {};
  }

 private:
  [[nodiscard]] std::string placeOfRoot() const {
    return root_.place.empty() ? "the file" : root_.place;
  }
  void text(const char* key, std::string& value) {
    const JsonNode node = JsonReader::member(root_, key);
    if (node.json != nullptr) value = json_.text(node);
  }
  void triple(const char* key, double farthest, Triple& value) {
    json_.numbers(JsonReader::member(root_, key), farthest, value);
  }
  void checkScale(const char* key) {
    const Triple& s = attributes_.scale;
    if (std::all_of(s.begin(), s.end(), [](double v) { return v != 0; })) return;
    json_.error(JsonReader::member(root_, key).place, "a scale of 0 flattens it");
  }
  void readRigid() {
    text("render_asset", attributes_.render_asset);
    text("collision_asset", attributes_.collision_asset);
    triple("scale", kLargestScale, attributes_.scale);
    checkScale("scale");
    triple("up", kLargestScale, attributes_.up);
    triple("front", kLargestScale, attributes_.front);
    // As in Habitat, a file that states none takes back what the defaults stated.
    attributes_.center_of_mass.reset();
    if (JsonReader::member(root_, "COM").json != nullptr) {
      triple("COM", kFarthest, attributes_.center_of_mass.emplace());
    }
    const JsonNode collidable = JsonReader::member(root_, "is_collidable");
    if (collidable.json != nullptr) attributes_.collidable = json_.flag(collidable);
    // Read for their type only: they belong to the simulator and to drawing.
    static_cast<void>(json_.flag(JsonReader::member(root_, "force_flat_shading")));
    static_cast<void>(json_.number(JsonReader::member(root_, "semantic_id"), 0, kLargestId));
  }
  void readArticulated() {
    text("urdf_filepath", attributes_.urdf);
    const JsonNode scale = JsonReader::member(root_, "uniform_scale");
    if (scale.json == nullptr) return;
    attributes_.scale.fill(json_.number(scale, -kLargestScale, kLargestScale));
    checkScale("uniform_scale");
  }

  JsonReader json_;
  JsonNode root_;
  TemplateAttributes& attributes_;
};

/// Whether a file that names no frame counts as Z up: Habitat takes every bare GLB stage for a
/// Matterport3D scan.
bool isBareScan(const DatasetTemplate& entry, const DatasetBlock& block, TemplateKind kind) {
  return kind == TemplateKind::kStage && entry.config.empty() && !block.defaults &&
         entry.asset.extension() == ".glb";
}

/// Puts the template's name where a default says that it belongs.
void insertName(std::string& path, const std::string& name) {
  constexpr std::string_view kPlace = "%%CONFIG_NAME_AS_ASSET_FILENAME%%";
  const std::size_t at = path.find(kPlace);
  if (at != std::string::npos) path.replace(at, kPlace.size(), name);
}

Result<void> checkFrame(const TemplateAttributes& attributes, const std::string& where) {
  constexpr double kRightAngle = 1e-3;
  const double up = dotOf(attributes.up, attributes.up);
  const double front = dotOf(attributes.front, attributes.front);
  const double cosine = dotOf(attributes.up, attributes.front) / std::sqrt(up * front);
  if (up > 0 && front > 0 && std::abs(cosine) <= kRightAngle) return {};
  return fail(ErrorCode::kInvalidInput, where,
              fmt::format("up ({}) and front ({}) must be at right angles; give both",
                          fmt::join(attributes.up, ", "), fmt::join(attributes.front, ", ")));
}

/// The document that is the template's own file, which it has to have.
Result<Json> readTemplateFile(const DatasetTemplate& entry, TemplateKind kind) {
  const TemplateKindNames& names = namesOf(kind);
  return readJsonFile(entry.config, {.what = names.noun == "articulated object"
                                                 ? std::string_view("an articulated object")
                                                 : names.noun,
                                     .suffix = names.suffix,
                                     .max_bytes = kMaxFileBytes});
}

}  // namespace

Result<std::vector<AttributeLayer>> layersOf(const DatasetTemplate& entry,
                                             const DatasetBlock& block, TemplateKind kind) {
  std::vector<AttributeLayer> layers;
  layers.reserve(2 + entry.layers.size());
  if (block.defaults) layers.push_back(*block.defaults);
  if (!entry.config.empty()) {
    ASSIGN_OR_RETURN(auto json, readTemplateFile(entry, kind));
    layers.push_back({entry.config.string(), "", std::move(json)});
  }
  layers.insert(layers.end(), entry.layers.begin(), entry.layers.end());
  return layers;
}

Result<TemplateAttributes> readAttributes(const DatasetTemplate& entry, const DatasetBlock& block,
                                          TemplateKind kind) {
  TemplateAttributes attributes;
  if (isBareScan(entry, block, kind)) {
    attributes.up = {0, 0, 1};
    attributes.front = {0, 1, 0};
  }
  ASSIGN_OR_RETURN(const auto layers, layersOf(entry, block, kind));
  for (const AttributeLayer& layer : layers) {
    RETURN_IF_ERROR(LayerReader(layer, attributes).read(kind));
  }
  insertName(attributes.render_asset, entry.name);
  insertName(attributes.collision_asset, entry.name);
  RETURN_IF_ERROR(checkFrame(attributes, placeOf(entry)));
  return attributes;
}

std::string placeOf(const DatasetTemplate& entry) {
  return entry.config.empty() ? entry.handle : entry.config.string();
}

fs::path fileOf(const DatasetTemplate& entry, const std::string& stated) {
  return (entry.folder / stated).lexically_normal();
}

Result<fs::path> meshFileOf(const DatasetTemplate& entry, const TemplateAttributes& attributes) {
  const std::string& stated =
      attributes.render_asset.empty() ? attributes.collision_asset : attributes.render_asset;
  if (!stated.empty()) return fileOf(entry, stated);
  if (!entry.asset.empty()) return entry.asset;
  return fail(ErrorCode::kInvalidInput, placeOf(entry) + ": render_asset",
              "it is missing; name the mesh to place");
}

fs::path urdfOf(const DatasetTemplate& entry, const TemplateAttributes& attributes) {
  if (!attributes.urdf.empty()) return fileOf(entry, attributes.urdf);
  return entry.asset.empty() ? entry.folder / (entry.name + ".urdf") : entry.asset;
}

}  // namespace galactic::bake
