#pragma once
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/bake_folder.h"
#include "support/build_paths.h"
#include "support/file_content.h"

namespace galactic::test {

/// The content of packs by their names.
using PackContents = std::map<std::string, std::string>;

inline std::string sampleFile(const std::string& name) {
  return (test::sourceFolder() / "packs/sample/" / name).string();
}

/// A scene dataset of the sample apartment in `data`: scenes a and b with a mug that stands there
/// and a box that moves, c with the apartment alone, d that lacks a lamp, and e without its stage.
/// Its scenes share textures. Few radii and no replay: less than a second for a scene.
class PlanFolder : public BakeFolder {
 protected:
  void SetUp() override {
    const std::string name = "data/home.scene_dataset_config.json";
    write(name, R"({"stages": {"paths": {".json": ["stages"]}},
                    "objects": {"paths": {".json": ["objects"]}},
                    "scene_instances": {"paths": {".json": ["scenes"]}}})");
    addTemplate("stages/flat.stage_config.json", "apartment.glb");
    addTemplate("objects/mug.object_config.json", "objects/mug.glb");
    addTemplate("objects/box.object_config.json", "objects/cereal_box.glb");
    const std::string box = R"({"template_name": "box", "motion_type": "DYNAMIC",
                                "translation_origin": "asset_local"})";
    addScene("a", "flat", thing("mug", 1) + ", " + box);
    addScene("b", "flat", thing("mug", 2) + ", " + box);
    addScene("c", "flat", "");
    addScene("d", "flat", thing("lamp", 1));
    addScene("e", "hall", "");
  }

  /// Writes a configuration whose mesh is a copy of one of packs/sample.
  void addTemplate(const std::string& config, const std::string& mesh) {
    write("data/" + config,
          fmt::format(R"({{"render_asset": "../meshes/{}", "up": [0, 1, 0], "front": [0, 0, -1]}})",
                      mesh));
    write("data/meshes/" + mesh, fileContent(sampleFile(mesh)));
  }
  void addScene(const std::string& name, const std::string& stage, const std::string& objects) {
    write(
        "data/scenes/" + name + ".scene_instance.json",
        fmt::format(R"({{"stage_instance": {{"template_name": "{}"}}, "object_instances": [{}]}})",
                    stage, objects));
  }
  static std::string thing(const std::string& name, double x) {
    return fmt::format(
        R"({{"template_name": "{}", "motion_type": "STATIC", "translation": [{}, 1, 1]}})", name,
        x);
  }

  /// The arguments that bake the dataset's scenes into `out`/home.pack and its folder.
  [[nodiscard]] static std::vector<std::string> datasetArguments(
      const std::string& out, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"data/home.scene_dataset_config.json",
                                       "-o",
                                       out + "/home.pack",
                                       "--report",
                                       "report.json",
                                       "--radii",
                                       "0.05,0.12",
                                       "--check-columns",
                                       "0"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  [[nodiscard]] ProgramRun bake(const std::string& out,
                                const std::vector<std::string>& more = {}) const {
    return run(datasetArguments(out, more));
  }

  /// The names of the texture packs below `out`, ascending.
  [[nodiscard]] std::vector<std::string> textures(const std::string& out) const {
    std::vector<std::string> names;
    for (const auto& [name, content] : packsIn(out)) {
      if (name.find("/textures/") != std::string::npos) names.push_back(out + "/" + name);
    }
    return names;
  }
  /// Damages the last byte of a file.
  void damage(const std::string& name) {
    std::string bytes = content(name);
    bytes.back() = static_cast<char>(bytes.back() ^ 1);
    std::filesystem::remove(path(name));
    write(name, bytes);
  }

  [[nodiscard]] nlohmann::json report() const {
    return nlohmann::json::parse(content("report.json"), nullptr, false);
  }
  /// From the last report: which packs are in this state.
  [[nodiscard]] std::vector<std::string> packsThatAre(const std::string& state) const {
    std::vector<std::string> names;
    const nlohmann::json last = report();
    for (const auto& pack : last.at("run").at("packs")) {
      if (pack.at("state") == state) names.push_back(pack.at("pack").get<std::string>());
    }
    return names;
  }

  /// All packs below `out` but those in the cache, by their paths below it.
  [[nodiscard]] PackContents packsIn(const std::string& out) const {
    PackContents packs;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path(out))) {
      const std::string name = entry.path().lexically_relative(path(out)).generic_string();
      const bool is_cached = name.find(".cache/") != std::string::npos;
      if (entry.is_regular_file() && !is_cached) packs.emplace(name, fileContent(entry.path()));
    }
    return packs;
  }
};

/// Whether two bakes made the same files, byte for byte.
inline void expectSamePacks(const PackContents& found, const PackContents& wanted) {
  for (const auto& [name, content] : wanted) {
    ASSERT_EQ(found.count(name), 1U) << name << " is missing";
    EXPECT_TRUE(found.at(name) == content) << name << " differs";
  }
  for (const auto& [name, content] : found) {
    EXPECT_EQ(wanted.count(name), 1U) << name << " is too many";
  }
}

}  // namespace galactic::test
