#include "galactic/bake/jobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "common/overload.h"
#include "galactic/bake/robot_import.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

fs::path relativeTo(const fs::path& folder, const fs::path& file) {
  std::error_code problem;
  return fs::absolute(file, problem).lexically_normal().lexically_relative(folder);
}

/// Collects the options that have a value, with `rename` applied to the paths in them.
template <class Rename>
class ValueList final : public OptionVisitor {
 public:
  explicit ValueList(Rename rename) : rename_(std::move(rename)) {}
  using OptionVisitor::option;
  void option(const OptionInfo& info, OptionField& field) override {
    for (fs::path* path : field.paths()) *path = rename_(*path);
    for (std::string& text : field.texts()) values.emplace_back(info.name, std::move(text));
  }

  std::vector<std::pair<std::string, std::string>> values;

 private:
  Rename rename_;
};

class PathList final : public OptionVisitor {
 public:
  using OptionVisitor::option;
  void option(const OptionInfo& /*info*/, OptionField& field) override {
    // Packages are folders, from which only some files are read.
    if (field.kind() == OptionKind::kNamedPath) return;
    for (const fs::path* path : field.paths()) paths.push_back(*path);
  }

  std::vector<fs::path> paths;
};

class NameList final : public OptionVisitor {
 public:
  using OptionVisitor::option;
  void option(const OptionInfo& info, OptionField& /*field*/) override {
    if (std::ranges::find(names, info.name) == names.end()) names.emplace_back(info.name);
  }

  std::vector<std::string> names;
};

std::vector<fs::path> inputsOf(const Job& job) {
  return std::visit(Overload{[](const ObjectJob& one) { return one.inputs; },
                             [](const EpisodeGenerationJob& one) { return one.packs; },
                             [](const WorldJob& one) { return one.packs; },
                             [](const EpisodeImportJob& one) {
                               std::vector<fs::path> files{one.input};
                               files.insert(files.end(), one.packs.begin(), one.packs.end());
                               return files;
                             },
                             [](const auto& one) { return std::vector<fs::path>{one.input}; }},
                    job);
}

/// What affects the pack's bytes but is neither an option nor a file.
std::string internalsOf(const Job& job) {
  return std::visit(
      Overload{[](const SceneJob& one) {
                 if (!one.instance) return fmt::format("name={}\n", one.name);
                 return fmt::format("name={}\nscene {} {:016x}\n", one.name, one.instance->name,
                                    one.instance->dataset_fingerprint);
               },
               [](const ObjectJob& one) {
                 return fmt::format("name={}\nsmallest={}\n", one.name, one.import.smallest_size);
               },
               [](const RobotJob&) {
                 std::string searched;
                 for (const fs::path& root : rosPackagePath()) {
                   searched += fmt::format("packages {}\n", root.string());
                 }
                 return searched;
               },
               [](const auto&) { return std::string(); }},
      job);
}

}  // namespace

std::string_view kindOf(const Job& job) {
  return std::visit(
      Overload{[](const SceneJob&) { return "scene"; }, [](const ObjectJob&) { return "object"; },
               [](const RobotJob&) { return "robot"; }, [](const WorldJob&) { return "world"; },
               [](const auto&) { return "episodes"; }},
      job);
}

std::vector<std::string> optionNames() {
  NameList list;
  for (Job job : {Job(SceneJob{}), Job(ObjectJob{}), Job(RobotJob{}), Job(EpisodeImportJob{}),
                  Job(EpisodeGenerationJob{}), Job(WorldJob{})}) {
    visitOptions(job, list);
  }
  return std::move(list.names);
}

std::vector<fs::path> filesOf(const Job& job) {
  std::vector<fs::path> files = inputsOf(job);
  Job copy = job;
  PathList named;
  visitOptions(copy, named);
  files.insert(files.end(), named.paths.begin(), named.paths.end());
  return files;
}

std::vector<std::pair<std::string, std::string>> contentOptions(const Job& job) {
  Job copy = job;
  ValueList list([](const fs::path& path) {
    return path.has_filename() ? path.filename() : path.parent_path().filename();
  });
  if (!std::holds_alternative<SceneJob>(job)) list.values.emplace_back("as", kindOf(job));
  visitOptions(copy, list);
  return std::move(list.values);
}

Provenance provenanceOf(const Job& job, std::vector<SourceFile> sources,
                        std::vector<std::string> warnings) {
  Provenance provenance;
  provenance.tool_version = GALACTIC_VERSION;
  provenance.options = contentOptions(job);
  provenance.sources = std::move(sources);
  provenance.warnings = std::move(warnings);
  return provenance;
}

std::string keyOf(const Job& job, const fs::path& folder) {
  Job copy = job;
  ValueList list([&](const fs::path& path) { return relativeTo(folder, path); });
  visitOptions(copy, list);
  std::string key =
      fmt::format("galactic-bake {}\n{} {}\n", GALACTIC_VERSION, kindOf(job), job.index());
  for (const auto& [name, value] : list.values) key += fmt::format("{}={}\n", name, value);
  for (const fs::path& file : inputsOf(job)) {
    key += fmt::format("file {}\n", relativeTo(folder, file).generic_string());
  }
  return key + internalsOf(job);
}

}  // namespace galactic::bake
