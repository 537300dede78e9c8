#include "dynamics/sources/object_config.h"

#include <fmt/format.h>

#include <array>
#include <system_error>

#include "dynamics/sources/body_ranges.h"
#include "galactic/bake/habitat_names.h"
#include "json_reader.h"
#include "support/try.h"

namespace galactic::dynamics {
namespace {

using bake::Json;

bool isFile(const std::filesystem::path& path) {
  std::error_code none;
  return std::filesystem::is_regular_file(path, none);
}

/// A value as text, for a warning; lists and objects only by their kind, as they may be long and
/// deep.
std::string textOf(const Json& json) {
  if (json.is_array()) return "a list";
  return json.is_object() ? "an object" : json.dump();
}

/// A number within the range; none if it is missing, or, with a warning, if it is anything else.
std::optional<double> numberOf(const Json& json, const char* key, const Within<double>& range,
                               ObjectConfig& config) {
  const auto found = json.find(key);
  if (found == json.end()) return std::nullopt;
  if (found->is_number() && contains(range, found->get<double>())) return found->get<double>();
  config.warnings.push_back(
      fmt::format("has no usable '{}' in '{}': found {}, {}; the default counts", key,
                  config.file.filename().string(), textOf(*found), expectedText(range)));
  return std::nullopt;
}

void readCollisionAsset(const Json& json, ObjectConfig& config) {
  const auto found = json.find("collision_asset");
  if (found == json.end() || !found->is_string()) return;
  const std::filesystem::path asset = config.file.parent_path() / found->get<std::string>();
  if (isFile(asset)) {
    config.collision_asset = asset.lexically_normal();
    return;
  }
  config.warnings.push_back(
      fmt::format("has the collision asset {}, which is not there; the hull "
                  "of its mesh counts",
                  found->dump()));
}

}  // namespace

std::optional<std::filesystem::path> findObjectConfig(const std::filesystem::path& mesh,
                                                      std::string_view name) {
  constexpr int kFolders = 4;
  const std::string file = std::string(name) + std::string(bake::kObjectSuffix);
  std::filesystem::path folder = mesh.parent_path();
  for (int n = 0; n < kFolders; ++n) {
    for (const std::string_view below :
         std::to_array<std::string_view>({"", "configs", "configs/objects"})) {
      const std::filesystem::path candidate = folder / below / file;
      if (isFile(candidate)) return candidate;
    }
    if (folder == folder.parent_path()) break;
    folder = folder.parent_path();
  }
  return std::nullopt;
}

Result<ObjectConfig> readObjectConfig(const std::filesystem::path& file) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 20;
  ASSIGN_OR_RETURN(const Json json, bake::readJsonFile(file, {.what = "an object configuration",
                                                              .suffix = bake::kObjectSuffix,
                                                              .max_bytes = kMostBytes}));
  if (!json.is_object()) {
    return fail(ErrorCode::kInvalidInput, file.string(),
                "is no JSON object, which an object configuration is; mend or remove it");
  }
  ObjectConfig config;
  config.file = file;
  config.mass = numberOf(json, "mass", kMasses, config);
  config.friction = numberOf(json, "friction_coefficient", kFrictions, config);
  const auto joins = json.find("join_collision_meshes");
  config.joins_meshes = joins != json.end() && joins->is_boolean() && joins->get<bool>();
  readCollisionAsset(json, config);
  return config;
}

}  // namespace galactic::dynamics
