// Oriented boxes and stable poses of mesh files: volumes against the axis-aligned and the PCA box,
// and times, as a markdown table.
//
//   fit_boxes [--up z] [--starts N] FILE...
//
// With --starts, the last column tells how far the minimum box is above the best of as many random
// rotations, each walked downhill; the padding of the boxes is in it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "fit/stable_poses.h"
#include "galactic/bake/mesh_import.h"
#include "galactic/bake/oriented_box.h"
#include "galactic/bake/triangle_mesh.h"
#include "support/oracles/box_oracle.h"

namespace galactic::bake {
namespace {

constexpr std::uint32_t kSeed = 20250401;
constexpr int kRepeats = 5;

/// The median time of a few runs, milliseconds.
template <class Work>
double medianMs(const Work& work) {
  std::array<double, kRepeats> times{};
  for (double& time : times) {
    const auto start = std::chrono::steady_clock::now();
    work();
    time =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  std::sort(times.begin(), times.end());
  return times[kRepeats / 2];
}

/// A mesh repeats the vertices of its triangles.
std::vector<Vec3> withoutRepetitions(std::vector<Vec3> points) {
  const auto key = [](const Vec3& p) { return std::tie(p.x, p.y, p.z); };
  std::sort(points.begin(), points.end(),
            [&](const Vec3& a, const Vec3& b) { return key(a) < key(b); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

/// The last two parts of the path: names like "model.obj" tell nothing alone.
std::string shortName(const std::filesystem::path& path) {
  return (path.parent_path().filename() / path.filename()).string();
}

void printRow(const std::filesystem::path& path, const TriangleMesh& mesh, int starts) {
  const std::vector<Vec3> points = withoutRepetitions(mesh.vertices);
  const BoxFitResult yaw = fitOrientedBox(points, BoxFit::kYaw);
  const BoxFitResult least = fitOrientedBox(points, BoxFit::kMinimum);
  const std::vector<StablePose> poses = findStablePoses(mesh);
  const double box_ms = medianMs([&] { (void)fitOrientedBox(mesh.vertices, BoxFit::kYaw); });
  const double poses_ms = medianMs([&] { (void)findStablePoses(mesh); });
  fmt::print("| {} | {} | {:.4f} | {} | {:.4f} | {:.4f} | {:.1f} | {} | {:.3f} | {:.1f} |",
             shortName(path), points.size(), yaw.volume / yaw.axis_aligned_volume,
             yaw.used == BoxFit::kYaw ? "yaw" : "min", least.volume / least.axis_aligned_volume,
             least.volume / least.pca_volume, box_ms, poses.size(),
             static_cast<double>(poses.front().likelihood), poses_ms);
  if (starts > 0) {
    const double best = test::BoxOracle(points).bestVolume(kSeed, starts);
    fmt::print(" {:+.3f} % |", 100 * (least.volume / best - 1));
  }
  fmt::print("\n");
}

int printTable(const std::vector<std::string>& files, const MeshImportOptions& options,
               int starts) {
  fmt::print(
      "| file | vertices | default / AABB | used | min / AABB | min / PCA | box ms | poses |"
      " likeliest | poses ms |{}\n",
      starts > 0 ? " over best of random |" : "");
  fmt::print("|---|---|---|---|---|---|---|---|---|---|{}\n", starts > 0 ? "---|" : "");
  for (const std::string& file : files) {
    const auto asset = importMesh(file, options);
    const auto clean = asset ? placeAndClean(*asset) : tl::unexpected(asset.error());
    if (!clean) {
      fmt::print(stderr, "{}: {}\n", clean.error().where, clean.error().message);
      return static_cast<int>(clean.error().code);
    }
    printRow(file, clean->mesh, starts);
  }
  return 0;
}

}  // namespace
}  // namespace galactic::bake

int main(int argc, char** argv) {
  using galactic::bake::UpAxis;
  try {
    CLI::App app("Oriented boxes and stable poses of mesh files, and their times");
    std::vector<std::string> files;
    int starts = 0;
    galactic::bake::MeshImportOptions options;
    UpAxis up = UpAxis::kY;
    const std::map<std::string, UpAxis> axes{{"y", UpAxis::kY}, {"z", UpAxis::kZ}};
    app.add_option("FILE", files, "Mesh files")->required();
    app.add_option("--up", up, "Up axis of the files: y or z")
        ->transform(CLI::CheckedTransformer(axes));
    app.add_option("--starts", starts, "Random rotations to compare with; 0 for none");
    CLI11_PARSE(app, argc, argv);
    options.up = up;
    return galactic::bake::printTable(files, options, starts);
  } catch (const std::exception& error) {
    std::fputs(error.what(), stderr);
    return static_cast<int>(galactic::ErrorCode::kInternal);
  }
}
