// Render meshes of mesh files and URDFs: triangles, clusters and bytes before and after, the error
// that was measured, and seconds, as a markdown table.
//
//   bake_render [--error METERS] [--texture-size N] [--threads N] FILE...
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "galactic/bake/mesh_import.h"
#include "galactic/bake/render_baker.h"
#include "galactic/bake/robot_import.h"
#include "render/render_source.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

struct Options {
  std::vector<std::filesystem::path> files;
  RenderBakeOptions meshes;
  TextureBakeOptions textures;
  unsigned threads = 1;
};

/// A row of the table.
struct Row {
  RenderBakeStatistics figures;
  std::size_t textures = 0;
  /// Of textures, and of meshes.
  double texture_seconds = 0;
  double seconds = 0;

  Row& operator+=(const Row& more) {
    figures += more.figures;
    textures += more.textures;
    texture_seconds += more.texture_seconds;
    seconds += more.seconds;
    return *this;
  }
};

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void print(const std::string& name, const Row& row) {
  const RenderBakeStatistics& f = row.figures;
  const auto megabytes = [](std::uint64_t bytes) { return static_cast<double>(bytes) / 1e6; };
  fmt::print(
      "| {} | {} | {} | {} | {} | {:.2f} | {:.3f} | {:.3f} | {} | {:.2f} | {:.2f} | {:.2f} | "
      "{:.2f} "
      "|\n",
      name, f.source_triangles, f.triangles, f.two_sided_triangles, f.clusters,
      1e3 * static_cast<double>(f.largest_error), megabytes(f.source_bytes), megabytes(f.bytes),
      row.textures, megabytes(f.source_texture_bytes), megabytes(f.texture_bytes),
      row.texture_seconds, row.seconds);
}

/// Bakes what `make_source` gives.
template <class MakeSource>
Result<Row> bakeRow(const MakeSource& make_source, const Options& options) {
  auto start = std::chrono::steady_clock::now();
  const Result<RenderSource> source = make_source();
  if (!source) return tl::unexpected(source.error());
  Row row;
  row.texture_seconds = secondsSince(start);
  start = std::chrono::steady_clock::now();
  ASSIGN_OR_RETURN(const auto meshes, bakeRenderMeshes(*source, options.meshes, options.threads));
  row.seconds = secondsSince(start);
  row.figures = meshes.statistics();
  row.textures = meshes.materials.textures.size();
  return row;
}

Result<Row> bakeFile(const std::filesystem::path& file, const Options& options) {
  if (file.extension() == ".urdf") {
    RobotImportOptions import;
    import.allow_missing = true;
    ASSIGN_OR_RETURN(const auto robot, importRobot(file, import));
    return bakeRow(
        [&] {
          return robotRenderSource(robot, file.parent_path(), options.textures, options.threads);
        },
        options);
  }
  ASSIGN_OR_RETURN(const auto asset, importMesh(file));
  return bakeRow(
      [&] {
        return sceneRenderSource(asset, file.parent_path(), options.textures, options.threads);
      },
      options);
}

int run(const Options& options) {
  fmt::print(
      "| file | triangles | drawn | two-sided | clusters | error mm | source MB | MB | textures | "
      "decoded MB | MB | textures s | meshes s |\n|---|{}\n",
      "---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
  Row all;
  for (const std::filesystem::path& file : options.files) {
    const Result<Row> row = bakeFile(file, options);
    if (!row) {
      fmt::print(stderr, "{}: {}\n", row.error().where, row.error().message);
      return static_cast<int>(row.error().code);
    }
    print(file.filename().string(), *row);
    all += *row;
  }
  print("all", all);
  return 0;
}

}  // namespace
}  // namespace galactic::bake

int main(int argc, char** argv) {
  galactic::bake::Options options;
  CLI::App app{"Bakes render meshes and prints their figures as a markdown table"};
  app.add_option("files", options.files, "Meshes and URDFs")->required();
  app.add_option("--error", options.meshes.error, "Of the surface, meters")->capture_default_str();
  app.add_option("--texture-size", options.textures.largest, "Longest edge, texels")
      ->capture_default_str();
  app.add_option("-j,--threads", options.threads, "Threads")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    return galactic::bake::run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "internal error: {}\n", error.what());
    return 4;
  }
}
