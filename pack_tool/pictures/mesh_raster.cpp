#include "pack_tool/pictures/mesh_raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <utility>

#include "galactic/batch_renderer.h"
#include "galactic/render_library.h"
#include "pack_tool/mesh/sphere_mesh.h"
#include "pictures/palette.h"
#include "view/render_surfaces.h"

namespace galactic::pictures {

namespace {

/// Samples along each edge of a pixel.
constexpr int kSamples = 2;
constexpr float kNothing = -std::numeric_limits<float>::infinity();
/// Units of the frame that is drawn: the lattice of its vertices is finer than a hundredth of this.
constexpr double kSamplesPerUnit = 16;
/// How far away the viewer is, in heights of the picture.
constexpr double kLens = 256;
/// Vertices beyond this many units are left out: a render mesh is at most 65,535 across with this
/// lattice. A picture is 256 wide at most.
constexpr float kFarthest = 30000;
/// Cuts of an icosahedron: a sphere's outline is round to half a percent.
constexpr int kSphereCuts = 3;
constexpr std::uint32_t kOpaque = 0xFF000000;
/// Of the light: what reaches every side, and what comes from over the viewer's left shoulder.
constexpr double kAmbient = 0.35;
constexpr double kDiffuse = 0.65;
/// Textures have light in them: their shading is weaker.
constexpr double kLeastOfTextures = 0.55;
/// The least light of what is not shaded.
constexpr double kAsItIs = 1;
constexpr std::array<double, 3> kLight{-0.37, 0.56, 0.74};
/// How much of what lies behind a sphere it covers.
constexpr double kSphereShare = 0.5;
/// How much of a line is seen in front of meshes and behind them.
constexpr double kLineShare = 1;
constexpr double kHiddenLineShare = 0.3;
/// Half the width of a line, samples.
constexpr double kHalfLine = 1.5;
/// Lines on a surface lie in front of it: share of the view's height.
constexpr double kLineBias = 2e-3;

double dotProduct(const Vec3& a, const Vec3& b) {
  return static_cast<double>(a.x) * static_cast<double>(b.x) +
         static_cast<double>(a.y) * static_cast<double>(b.y) +
         static_cast<double>(a.z) * static_cast<double>(b.z);
}

Vec3 unit(const Vec3& v) { return v * static_cast<float>(1 / std::sqrt(dotProduct(v, v))); }

Rgb shaded(Rgb color, double light) {
  const auto scaled = [light](std::uint8_t value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value * light, 0.0, 255.0)));
  };
  return {scaled(color.r), scaled(color.g), scaled(color.b)};
}

/// Light on a side whose normal, in the view's axes, is (x, y, z) with z towards the viewer.
double lightOn(double x, double y, double z) {
  const double length = std::sqrt(x * x + y * y + z * z);
  if (!(length > 0)) return kAmbient;
  const double facing = (kLight[0] * x + kLight[1] * y + kLight[2] * z) / length;
  return kAmbient + kDiffuse * std::max(facing, 0.0);
}

/// The samples [begin, end) of one direction.
struct SampleRange {
  int begin = 0;
  int end = 0;
};

/// Those whose centers lie between two positions and inside the picture.
SampleRange samplesBetween(double low, double high, int count) {
  const auto clamped = [count](double value) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(count)));
  };
  return {clamped(std::ceil(low - 0.5)), clamped(std::floor(high - 0.5) + 1)};
}

std::uint32_t packed(Rgb color) {
  return std::uint32_t{color.r} | std::uint32_t{color.g} << 8U | std::uint32_t{color.b} << 16U |
         kOpaque;
}

Rgb unpacked(std::uint32_t color) {
  return {static_cast<std::uint8_t>(color), static_cast<std::uint8_t>(color >> 8U),
          static_cast<std::uint8_t>(color >> 16U)};
}

/// What one surface of a model is made of.
using SurfaceKind = std::pair<std::uint16_t, bool>;

SurfaceKind kindOf(const RenderSurface& surface) { return {surface.material, surface.two_sided}; }

/// The kinds whose vertices have colors of their own: light that was baked, or scanned. White is
/// what the others of a pack have.
std::set<SurfaceKind> kindsWithLight(std::span<const RenderSurface> surfaces) {
  constexpr std::uint32_t kWhite = 0xFFFFFF;
  std::set<SurfaceKind> kinds;
  for (const RenderSurface& surface : surfaces) {
    const bool has_light = std::ranges::any_of(
        surface.vertices, [](const RenderVertex& v) { return (v.color & kWhite) != kWhite; });
    if (has_light) kinds.insert(kindOf(surface));
  }
  return kinds;
}

/// A texture coordinate that can be drawn: an image that repeats more often is a blur in any case.
float drawable(float coordinate) {
  return std::isfinite(coordinate) ? std::clamp(coordinate, -kMostImages, kMostImages) : 0;
}

/// Whether a picture can hold it; a comparison with NaN is false.
bool isNear(const Vec3& p) {
  return std::abs(p.x) < kFarthest && std::abs(p.y) < kFarthest && std::abs(p.z) < kFarthest;
}

}  // namespace

ViewAxes threeQuarterView() {
  const Vec3 toward = unit({0.80F, 0.55F, 0.75F});
  const Vec3 right = unit(cross({0, 1, 0}, toward));
  return {right, cross(toward, right), toward};
}

MeshRaster::MeshRaster(const RasterView& view)
    : view_(view),
      width_(view.width * kSamples),
      height_(view.height * kSamples),
      samples_per_meter_(view.pixels_per_meter * kSamples),
      distance_(kLens * std::max(width_, height_) / kSamplesPerUnit) {
  source_.parts.resize(2);
  source_.parts[1].part = 1;
  source_.materials.push_back({.name = "color of the vertices"});
  source_.semantics.emplace_back("figure");
  for (RenderPart& part : source_.parts) {
    part.surfaces.resize(1);
    part.surfaces.front().two_sided = true;
  }
}

Vec3 MeshRaster::inView(const Vec3& point) const {
  const Vec3 offset = point - view_.center;
  const double scale = samples_per_meter_ / kSamplesPerUnit;
  return {static_cast<float>(-scale * dotProduct(offset, view_.axes.toward)),
          static_cast<float>(scale * dotProduct(offset, view_.axes.up)),
          static_cast<float>(scale * dotProduct(offset, view_.axes.right))};
}

MeshRaster::Sample MeshRaster::project(const Vec3& point) const {
  const Vec3 offset = point - view_.center;
  const double depth = dotProduct(offset, view_.axes.toward) * samples_per_meter_ / kSamplesPerUnit;
  const double scale = samples_per_meter_ * distance_ / (distance_ - depth);
  return {0.5 * width_ + scale * dotProduct(offset, view_.axes.right),
          0.5 * height_ - scale * dotProduct(offset, view_.axes.up), depth};
}

void MeshRaster::addTriangle(RenderSurface& to, std::array<RenderVertex, 3> corners,
                             double least_light) const {
  if (!std::ranges::all_of(corners, [](const RenderVertex& v) { return isNear(v.position); })) {
    return;
  }
  const Vec3& origin = corners[0].position;
  const Vec3 normal = cross(corners[1].position - origin, corners[2].position - origin);
  // The side that is seen: X points away from the viewer.
  const double side = normal.x > 0 ? -1 : 1;
  const double light =
      lightOn(side * static_cast<double>(normal.z), side * static_cast<double>(normal.y),
              -side * static_cast<double>(normal.x));
  const double share = (light - kAmbient) / (1 - kAmbient);
  const double shown = least_light + (1 - least_light) * share;
  for (RenderVertex& corner : corners) {
    corner.color = packed(shaded(unpacked(corner.color), shown));
    to.corners.push_back(static_cast<std::uint32_t>(to.vertices.size()));
    to.vertices.push_back(corner);
  }
}

void MeshRaster::drawMesh(const RasterMesh& mesh, const Pose& world_from_mesh) {
  RenderSurface& surface = source_.parts[0].surfaces.front();
  for (std::size_t n = 0; n + 2 < mesh.corners.size(); n += 3) {
    std::array<RenderVertex, 3> corners;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t index = mesh.corners[n + corner];
      corners[corner].position = inView(world_from_mesh * mesh.positions[index]);
      corners[corner].color = mesh.colors.empty() ? packed(mesh.color) : mesh.colors[index];
    }
    addTriangle(surface, corners, kAmbient);
  }
}

std::size_t MeshRaster::firstMaterialOf(const RenderMeshes& meshes) {
  const auto found =
      std::ranges::find(packs_, &meshes, [](const auto& pack) { return pack.first; });
  if (found != packs_.end()) return found->second;
  const std::size_t first = source_.materials.size();
  const auto first_texture = static_cast<std::int32_t>(source_.textures.size());
  source_.textures.insert(source_.textures.end(), meshes.textures.begin(), meshes.textures.end());
  for (RenderMaterial material : meshes.materials) {
    if (material.texture >= 0) material.texture += first_texture;
    source_.materials.push_back(material);
  }
  packs_.emplace_back(&meshes, first);
  return first;
}

void MeshRaster::openRooms(const RoomCut& cut) { cut_ = cut; }

void MeshRaster::drawSection(std::span<const SectionLine> section, float height) {
  RenderSurface& surface = source_.parts[0].surfaces.front();
  for (const SectionRect& rect : filledSection(section, 1 / view_.pixels_per_meter)) {
    const auto corner = [&](float x, float z) {
      return RenderVertex{.position = inView({x, height, z}), .color = packed(kBlocked)};
    };
    const RenderVertex low = corner(rect.low_x, rect.low_z);
    const RenderVertex high = corner(rect.high_x, rect.high_z);
    addTriangle(surface, {low, corner(rect.low_x, rect.high_z), high}, kAsItIs);
    addTriangle(surface, {low, high, corner(rect.high_x, rect.low_z)}, kAsItIs);
  }
  for (const SectionLine& line : section) {
    drawLine({{line.from_x, height, line.from_z}, {line.to_x, height, line.to_z}, kInk});
  }
}

void MeshRaster::drawRenderModel(const RenderMeshes& meshes, const RenderModel& model,
                                 const Pose& world_from_model) {
  const std::size_t first = firstMaterialOf(meshes);
  std::vector<RenderSurface> surfaces = surfacesOf(meshes, model);
  const std::set<SurfaceKind> with_light = kindsWithLight(surfaces);
  std::vector<SectionLine> section;
  for (RenderSurface& stored : surfaces) {
    RenderSurface& surface = source_.parts[0].surfaces.emplace_back();
    surface.material = static_cast<std::uint16_t>(first + stored.material);
    surface.two_sided = stored.two_sided;
    for (RenderVertex& vertex : stored.vertices) {
      vertex.position = world_from_model * vertex.position;
      vertex.u = drawable(vertex.u);
      vertex.v = drawable(vertex.v);
    }
    if (cut_) cutThrough(*cut_, stored, section);
    for (RenderVertex& vertex : stored.vertices) vertex.position = inView(vertex.position);
    const bool textured = meshes.materials[stored.material].texture >= 0;
    const double without_light = textured ? kLeastOfTextures : kAmbient;
    const double least_light = with_light.contains(kindOf(stored)) ? kAsItIs : without_light;
    for (std::size_t n = 0; n + 2 < stored.corners.size(); n += 3) {
      const std::array<RenderVertex, 3> corners{stored.vertices[stored.corners[n]],
                                                stored.vertices[stored.corners[n + 1]],
                                                stored.vertices[stored.corners[n + 2]]};
      addTriangle(surface, corners, least_light);
    }
  }
  if (cut_) drawSection(section, cut_->height);
}

void MeshRaster::drawSphere(const RasterSphere& sphere, Rgb color) {
  const Vec3 center = inView(sphere.center);
  const auto radius =
      static_cast<float>(static_cast<double>(sphere.radius) * samples_per_meter_ / kSamplesPerUnit);
  if (!isNear(center) || !(radius < kFarthest)) return;
  const pack_tool::SphereMesh unit = pack_tool::makeSphereMesh(kSphereCuts);
  RenderSurface& surface = source_.parts[1].surfaces.emplace_back();
  surface.vertices.reserve(unit.points.size());
  for (const Vec3& p : unit.points) {
    const double light =
        lightOn(static_cast<double>(p.z), static_cast<double>(p.y), -static_cast<double>(p.x));
    surface.vertices.push_back(
        {.position = center + p * radius, .color = packed(shaded(color, light))});
  }
  surface.corners = unit.corners;
}

std::array<MeshRaster::Layer, 2> MeshRaster::render() const {
  const std::size_t samples = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  std::array<Layer, 2> layers;
  for (Layer& layer : layers) {
    layer.colors.assign(samples, kPaper);
    layer.depths.assign(samples, kNothing);
  }
  // Whatever the layout or the renderer could refuse was left out before.
  const Result<RenderMeshStorage> storage = buildRenderMeshes(source_);
  if (!storage) return layers;
  RenderLibrary library;
  library.add(storage->view());
  RenderOptions options;
  options.width = static_cast<std::uint32_t>(width_);
  options.height = static_cast<std::uint32_t>(height_);
  options.color = ColorFormat::kRgb8;
  options.near = static_cast<float>(0.5 * distance_);
  options.backend = RenderBackend::kSoft;
  options.threads = 1;
  auto renderer = BatchRenderer::create(library, options);
  if (!renderer) return layers;

  RenderCamera camera;
  camera.world_from_camera = rigidTransform({{static_cast<float>(-distance_), 0, 0}, Quat{}});
  camera.vertical_fov =
      static_cast<float>(2 * std::atan(0.5 * height_ / kSamplesPerUnit / distance_));
  std::vector<std::uint8_t> colors(std::size_t{6} * samples);
  std::vector<float> depths(2 * samples);
  const std::array<RenderInstance, 2> instances{
      {{.model = 0, .world_from_model = {}}, {.model = 1, .world_from_model = {}}}};
  std::array<RenderView, 2> views;
  for (std::size_t n = 0; n < views.size(); ++n) {
    const bool any = library.model(static_cast<std::uint32_t>(n)).cluster_count > 0;
    views[n] = {camera, std::span(instances).subspan(n, any ? 1 : 0)};
  }
  renderer->render(views, {.color = colors, .depth = depths, .semantics = {}});
  for (std::size_t n = 0; n < 2 * samples; ++n) {
    if (!(depths[n] > 0)) continue;
    Layer& layer = layers[n / samples];
    layer.colors[n % samples] = {colors[3 * n], colors[3 * n + 1], colors[3 * n + 2]};
    layer.depths[n % samples] = static_cast<float>(distance_ - static_cast<double>(depths[n]));
  }
  return layers;
}

void MeshRaster::drawLine(const RasterLine& line) { lines_.push_back(line); }

std::size_t MeshRaster::indexOf(SamplePlace place) const {
  return static_cast<std::size_t>(place.y) * static_cast<std::size_t>(width_) +
         static_cast<std::size_t>(place.x);
}

void MeshRaster::plotLine(const RasterLine& line, const Layer& meshes,
                          std::vector<Rgb>& samples) const {
  const Sample from = project(line.from);
  const Sample to = project(line.to);
  const double bias = kLineBias * height_ / kSamplesPerUnit;
  const double dx = to.x - from.x;
  const double dy = to.y - from.y;
  const double length = std::hypot(dx, dy);
  const SampleRange columns = samplesBetween(std::min(from.x, to.x) - kHalfLine,
                                             std::max(from.x, to.x) + kHalfLine, width_);
  const SampleRange rows = samplesBetween(std::min(from.y, to.y) - kHalfLine,
                                          std::max(from.y, to.y) + kHalfLine, height_);
  for (int y = rows.begin; y < rows.end; ++y) {
    for (int x = columns.begin; x < columns.end; ++x) {
      const double px = x + 0.5 - from.x;
      const double py = y + 0.5 - from.y;
      // Share of the way of the line's nearest point.
      const double way =
          length > 0 ? std::clamp((px * dx + py * dy) / (length * length), 0.0, 1.0) : 0.0;
      if (std::hypot(px - way * dx, py - way * dy) > kHalfLine) continue;
      const std::size_t index = indexOf({x, y});
      const double depth = from.depth + way * (to.depth - from.depth) + bias;
      const bool hidden = depth < static_cast<double>(meshes.depths[index]);
      samples[index] = blend(samples[index], line.color, hidden ? kHiddenLineShare : kLineShare);
    }
  }
}

void MeshRaster::compose(Image& image, int left, int top) const {
  const auto [meshes, spheres] = render();
  std::vector<Rgb> samples = meshes.colors;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    if (spheres.depths[n] > meshes.depths[n]) {
      samples[n] = blend(samples[n], spheres.colors[n], kSphereShare);
    }
  }
  for (const RasterLine& line : lines_) plotLine(line, meshes, samples);
  for (int y = 0; y < view_.height; ++y) {
    for (int x = 0; x < view_.width; ++x) {
      std::array<unsigned, 3> sum{};
      for (int s = 0; s < kSamples * kSamples; ++s) {
        const Rgb& sample =
            samples[indexOf({x * kSamples + s % kSamples, y * kSamples + s / kSamples})];
        sum[0] += sample.r;
        sum[1] += sample.g;
        sum[2] += sample.b;
      }
      const auto mean = [](unsigned total) {
        constexpr unsigned kCount = kSamples * kSamples;
        return static_cast<std::uint8_t>((total + kCount / 2) / kCount);
      };
      image.set(left + x, top + y, {mean(sum[0]), mean(sum[1]), mean(sum[2])});
    }
  }
}

}  // namespace galactic::pictures
