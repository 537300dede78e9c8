#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "json/json_reader.h"

namespace galactic::bake {

/// Attributes stated inside another file, applied over what came before.
struct AttributeLayer {
  /// For messages: the file that has them and where.
  std::string file;
  std::string place;
  Json json;
};

/// Something that scenes name: a stage, an object, an articulated object, or a scene itself.
struct DatasetTemplate {
  /// Without folders and endings, for example "frl_apartment_sofa".
  std::string name;
  /// Path relative to the dataset's folder, or the handle that the dataset gives.
  std::string handle;
  /// The file with its attributes, absolute; empty where there is none.
  std::filesystem::path config;
  /// The mesh or URDF that was found itself, absolute; empty where the attributes name it.
  std::filesystem::path asset;
  /// What paths in its attributes are relative to.
  std::filesystem::path folder;
  std::vector<AttributeLayer> layers;
};

/// What a name stands for.
struct FoundTemplate {
  /// Null where nothing has the name.
  const DatasetTemplate* found = nullptr;
  /// Whether others match as well.
  bool ambiguous = false;
};

/// The templates of one kind, by the names that scenes use for them.
class TemplateList {
 public:
  /// Ignores what is there already.
  void add(const DatasetTemplate& entry);
  /// Adds layers to the template at `handle`.
  void addLayer(const std::string& handle, AttributeLayer layer);
  /// Puts `entry` in the place of one with the same handle.
  void replace(DatasetTemplate entry);

  /// The template whose handle, else whose name, else whose handle without its ending is `wanted`;
  /// else the first (ascending) whose handle ends with it after a slash, else contains it, upper
  /// and lower case alike. Habitat takes the first that contains it.
  [[nodiscard]] FoundTemplate find(std::string_view wanted) const;

  /// By handle.
  [[nodiscard]] const std::map<std::string, DatasetTemplate>& all() const { return by_handle_; }

 private:
  std::map<std::string, DatasetTemplate> by_handle_;
  std::multimap<std::string, std::string, std::less<>> handles_of_name_;
};

}  // namespace galactic::bake
