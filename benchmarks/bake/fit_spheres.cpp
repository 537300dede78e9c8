// Sphere sets of meshes and how good they are, as a markdown table.
//
//   fit_spheres [OPTIONS] MESH...
//
// Lengths are in millimeters; gap and protrusion are mean / 95th percentile / maximum over samples
// that the solver has not seen. Seconds are of user time, so that other programs on the machine
// matter little.
#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "galactic/bake/mesh_import.h"
#include "galactic/bake/sphere_set.h"
#include "galactic/bake/triangle_mesh.h"
#include "recipe/collection_shape.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// What the command line asks for.
struct Request {
  std::vector<std::filesystem::path> meshes;
  SphereSetOptions options;
  unsigned threads = 1;
  bool z_up = false;
  bool support = true;
  bool curve = false;
  /// "box" or "cylinder": the published rule's spheres instead of ours.
  std::string rule;
};

double userSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

std::string perRadius(const std::vector<SetSphere>& spheres, std::size_t radii) {
  std::string text;
  for (std::size_t rank = radii; rank-- > 0;) {
    const auto count = std::count_if(spheres.begin(), spheres.end(), [&](const SetSphere& sphere) {
      return sphere.radius_index == rank;
    });
    text += fmt::format("{}{}", text.empty() ? "" : "/", count);
  }
  return text;
}

std::string inMillimeters(const LengthStatistics& lengths) {
  return fmt::format("{:.1f} / {:.1f} / {:.1f}", 1000 * lengths.mean, 1000 * lengths.p95,
                     1000 * lengths.max);
}

void printRow(const std::string& name, const SphereSet& set, std::size_t radii, double seconds) {
  const SphereSetQuality& quality = set.quality;
  fmt::print("| {} | {} | {} | {} | {} | {:.1f} / {:.1f} | {:.2f} | {} of {} | {:.2f} |\n", name,
             set.spheres.size(), perRadius(set.spheres, radii), inMillimeters(quality.gap),
             inMillimeters(quality.protrusion), 1000 * set.guaranteed_gap,
             1000 * set.guaranteed_protrusion, quality.volume_ratio, quality.thin_points,
             quality.samples, seconds);
  std::fflush(stdout);
}

/// The published rule for an object of these bounds. It counts along the axes of a Z up file.
Result<AuthoredShape> publishedShape(const Bounds& bounds, const std::string& rule,
                                     const std::vector<float>& radii) {
  const auto in_file = [](float x, float y, float z) {
    return std::array{static_cast<double>(x), static_cast<double>(-z), static_cast<double>(y)};
  };
  CollectionObject object;
  object.box_min = in_file(bounds.min.x, bounds.min.y, bounds.max.z);
  object.box_max = in_file(bounds.max.x, bounds.max.y, bounds.min.z);
  object.technique = rule == "cylinder" ? SphereTechnique::kUprightCylinder : SphereTechnique::kBox;
  return shapeFromCollection(object, UpAxis::kZ, radii);
}

Result<std::vector<SphereSet>> makeSets(const TriangleMesh& mesh, const Request& request,
                                        const SphereSetOptions& options) {
  if (!request.rule.empty()) {
    SphereSet set;
    ASSIGN_OR_RETURN(auto shape, publishedShape(mesh.bounds, request.rule, options.radii));
    set.spheres = std::move(shape.spheres);
    ASSIGN_OR_RETURN(const auto quality,
                     measureSphereSet(mesh, set.spheres, options, request.threads));
    set.quality = quality;
    return std::vector{set};
  }
  if (request.curve) {
    auto curve = SphereCurve::begin(mesh, options, request.threads);
    if (!curve) return tl::unexpected(curve.error());
    while (!curve->complete()) {
      if (auto refined = curve->refine(request.threads); !refined)
        return tl::unexpected(refined.error());
    }
    std::vector<SphereSet> sets;
    for (std::size_t n = 0; n < curve->points().size(); ++n) sets.push_back(curve->take(n));
    return sets;
  }
  ASSIGN_OR_RETURN(auto set, fitSphereSet(mesh, options, request.threads));
  return std::vector{set};
}

Result<void> fit(const std::filesystem::path& path, const Request& request) {
  MeshImportOptions import_options;
  if (request.z_up) import_options.up = UpAxis::kZ;
  ASSIGN_OR_RETURN(const auto asset, importMesh(path, import_options));
  ASSIGN_OR_RETURN(const auto clean, placeAndClean(asset));
  SphereSetOptions options = request.options;
  if (request.support) options.support = HalfSpace{{0, 1, 0}, clean.mesh.bounds.min.y};
  const double before = userSeconds();
  ASSIGN_OR_RETURN(const auto sets, makeSets(clean.mesh, request, options));
  const double seconds = userSeconds() - before;
  for (const SphereSet& set : sets) {
    printRow(path.parent_path().filename().string(), set, options.radii.size(), seconds);
  }
  return {};
}

int run(const Request& request) {
  fmt::print(
      "| mesh | spheres | largest radius first | gap | protrusion | guaranteed | volume ratio | "
      "thin | s |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const std::filesystem::path& path : request.meshes) {
    const auto done = fit(path, request);
    if (!done) {
      fmt::print(stderr, "fit_spheres: {}: {}: {}\n", path.string(), done.error().where,
                 done.error().message);
      return static_cast<int>(done.error().code);
    }
  }
  return kExitOk;
}

}  // namespace
}  // namespace galactic::bake

int main(int argc, char** argv) {
  try {
    CLI::App app("Sphere sets of meshes and their quality, as a markdown table");
    galactic::bake::Request request;
    app.add_option("MESH", request.meshes, "Mesh files")->required();
    app.add_option("--eps", request.options.eps, "Largest gap, meters");
    app.add_option("--tau", request.options.tau, "Largest protrusion, meters");
    app.add_option("--radii", request.options.radii, "Working set, meters, ascending");
    app.add_option("--max-spheres", request.options.max_spheres, "Most spheres; 0: no limit");
    app.add_option("--threads", request.threads, "Threads");
    app.add_flag("--z-up", request.z_up, "The files are Z up");
    app.add_flag("--support,!--no-support", request.support, "Nothing below the lowest point");
    app.add_flag("--curve", request.curve, "The whole trade-off curve");
    app.add_option("--rule", request.rule, "The published rule instead: box or cylinder")
        ->check(CLI::IsMember({"box", "cylinder"}));
    CLI11_PARSE(app, argc, argv);
    return galactic::bake::run(request);
  } catch (const std::exception& error) {
    std::fputs(error.what(), stderr);
    return static_cast<int>(galactic::ErrorCode::kInternal);
  }
}
