#include "pack_tool/pictures/mesh_raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pictures/palette.h"

namespace galactic::pictures {

namespace {

/// Samples along each edge of a pixel.
constexpr int kSamples = 2;
constexpr float kNothing = -std::numeric_limits<float>::infinity();
/// Of the light: what reaches every side, and what comes from over the viewer's left shoulder.
constexpr double kAmbient = 0.35;
constexpr double kDiffuse = 0.65;
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

Rgb shaded(Rgb colour, double light) {
  const auto scaled = [light](std::uint8_t value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value * light, 0.0, 255.0)));
  };
  return {scaled(colour.r), scaled(colour.g), scaled(colour.b)};
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

/// Those whose centres lie between two positions and inside the picture.
SampleRange samplesBetween(double low, double high, int count) {
  const auto clamped = [count](double value) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(count)));
  };
  return {clamped(std::ceil(low - 0.5)), clamped(std::floor(high - 0.5) + 1)};
}

Rgb meanColour(const RasterMesh& mesh, const std::array<std::uint32_t, 3>& corners) {
  if (mesh.colors.empty()) return mesh.colour;
  std::array<std::uint32_t, 3> sum{};
  for (const std::uint32_t corner : corners) {
    for (unsigned channel = 0; channel < 3; ++channel) {
      sum[channel] += (mesh.colors[corner] >> (8 * channel)) & 0xffU;
    }
  }
  return {static_cast<std::uint8_t>(sum[0] / 3), static_cast<std::uint8_t>(sum[1] / 3),
          static_cast<std::uint8_t>(sum[2] / 3)};
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
      samples_per_metre_(view.pixels_per_metre * kSamples) {
  const std::size_t samples = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  for (Layer* layer : {&mesh_, &spheres_}) {
    layer->colours.assign(samples, kPaper);
    layer->depths.assign(samples, kNothing);
  }
}

MeshRaster::Sample MeshRaster::project(const Vec3& point) const {
  const Vec3 offset = point - view_.centre;
  return {0.5 * width_ + samples_per_metre_ * dotProduct(offset, view_.axes.right),
          0.5 * height_ - samples_per_metre_ * dotProduct(offset, view_.axes.up),
          dotProduct(offset, view_.axes.toward)};
}

void MeshRaster::drawMesh(const RasterMesh& mesh, const Pose& world_from_mesh) {
  std::vector<Sample> projected;
  projected.reserve(mesh.positions.size());
  for (const Vec3& position : mesh.positions) {
    projected.push_back(project(world_from_mesh * position));
  }
  for (std::size_t n = 0; n + 2 < mesh.corners.size(); n += 3) {
    const std::array<std::uint32_t, 3> corners{mesh.corners[n], mesh.corners[n + 1],
                                               mesh.corners[n + 2]};
    drawTriangle({projected[corners[0]], projected[corners[1]], projected[corners[2]]},
                 meanColour(mesh, corners));
  }
}

void MeshRaster::drawTriangle(const std::array<Sample, 3>& c, Rgb colour) {
  const double ux = c[1].x - c[0].x;
  const double uy = c[1].y - c[0].y;
  const double vx = c[2].x - c[0].x;
  const double vy = c[2].y - c[0].y;
  const double area = ux * vy - uy * vx;
  if (area == 0) return;
  const double ud = c[1].depth - c[0].depth;
  const double vd = c[2].depth - c[0].depth;
  // Change of depth along x and y: the plane's slope, and with it the normal.
  const double slope_x = (ud * vy - uy * vd) / area;
  const double slope_y = (ux * vd - ud * vx) / area;
  const Rgb lit =
      shaded(colour, lightOn(-slope_x * samples_per_metre_, slope_y * samples_per_metre_, 1));

  const auto [low_x, high_x] = std::minmax({c[0].x, c[1].x, c[2].x});
  const auto [low_y, high_y] = std::minmax({c[0].y, c[1].y, c[2].y});
  const SampleRange columns = samplesBetween(low_x, high_x, width_);
  const SampleRange rows = samplesBetween(low_y, high_y, height_);
  for (int y = rows.begin; y < rows.end; ++y) {
    for (int x = columns.begin; x < columns.end; ++x) {
      const double px = x + 0.5 - c[0].x;
      const double py = y + 0.5 - c[0].y;
      const double b = (px * vy - py * vx) / area;
      const double g = (ux * py - uy * px) / area;
      if (b < 0 || g < 0 || b + g > 1) continue;
      plot(mesh_, {x, y}, c[0].depth + slope_x * px + slope_y * py, lit);
    }
  }
}

void MeshRaster::drawSphere(const RasterSphere& sphere, Rgb colour) {
  const Sample centre = project(sphere.centre);
  const auto metres = static_cast<double>(sphere.radius);
  const double radius = metres * samples_per_metre_;
  const SampleRange columns = samplesBetween(centre.x - radius, centre.x + radius, width_);
  const SampleRange rows = samplesBetween(centre.y - radius, centre.y + radius, height_);
  for (int y = rows.begin; y < rows.end; ++y) {
    for (int x = columns.begin; x < columns.end; ++x) {
      const double u = (x + 0.5 - centre.x) / radius;
      const double v = (y + 0.5 - centre.y) / radius;
      const double square = 1 - u * u - v * v;
      if (!(square > 0)) continue;
      const double height = std::sqrt(square);
      plot(spheres_, {x, y}, centre.depth + metres * height,
           shaded(colour, lightOn(u, -v, height)));
    }
  }
}

void MeshRaster::drawLine(const RasterLine& line) { lines_.push_back(line); }

void MeshRaster::plot(Layer& layer, SamplePlace place, double depth, Rgb colour) const {
  const std::size_t index = indexOf(place);
  const auto stored = static_cast<float>(depth);
  if (!(stored > layer.depths[index])) return;
  layer.depths[index] = stored;
  layer.colours[index] = colour;
}

std::size_t MeshRaster::indexOf(SamplePlace place) const {
  return static_cast<std::size_t>(place.y) * static_cast<std::size_t>(width_) +
         static_cast<std::size_t>(place.x);
}

void MeshRaster::plotLine(const RasterLine& line, std::vector<Rgb>& samples) const {
  const Sample from = project(line.from);
  const Sample to = project(line.to);
  const double bias = kLineBias * height_ / samples_per_metre_;
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
      const bool hidden = depth < static_cast<double>(mesh_.depths[index]);
      samples[index] = blend(samples[index], line.colour, hidden ? kHiddenLineShare : kLineShare);
    }
  }
}

void MeshRaster::compose(Image& image, int left, int top) const {
  std::vector<Rgb> samples = mesh_.colours;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    if (spheres_.depths[n] > mesh_.depths[n]) {
      samples[n] = blend(samples[n], spheres_.colours[n], kSphereShare);
    }
  }
  for (const RasterLine& line : lines_) plotLine(line, samples);
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
