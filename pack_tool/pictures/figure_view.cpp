#include "pack_tool/pictures/figure_view.h"

#include <algorithm>
#include <limits>

namespace galactic::pictures {

namespace {

using pack_tool::CameraMark;
using pack_tool::Figure;
using pack_tool::FigureKind;
using pack_tool::FigurePart;
using pack_tool::GraspMark;

/// What remains white around a figure: share of a view.
constexpr double kBorder = 0.06;
constexpr double kLeastExtent = 1e-3;
/// Length of the drawn part of a camera's view, and half the length of the cross at the grasp
/// point, which is seen also where the radius is tiny: shares of the robot's size.
constexpr float kCameraLength = 0.1F;
constexpr float kGraspCross = 0.02F;
/// Of the ball around the grasp point, meters.
constexpr float kLeastGraspRadius = 0.01F;

double along(const Vec3& axis, const Vec3& point) {
  return static_cast<double>(axis.x) * static_cast<double>(point.x) +
         static_cast<double>(axis.y) * static_cast<double>(point.y) +
         static_cast<double>(axis.z) * static_cast<double>(point.z);
}

void include(ViewWindow& window, const ViewAxes& axes, const RasterSphere& sphere) {
  const double right = along(axes.right, sphere.center);
  const double up = along(axes.up, sphere.center);
  const auto radius = static_cast<double>(sphere.radius);
  window.low_right = std::min(window.low_right, right - radius);
  window.high_right = std::max(window.high_right, right + radius);
  window.low_up = std::min(window.low_up, up - radius);
  window.high_up = std::max(window.high_up, up + radius);
}

/// The lines that show a camera: what it sees, and a roof where up is.
std::vector<RasterLine> cameraLines(const CameraMark& camera, float length) {
  const auto far = pack_tool::viewPyramid(camera, length);
  const Pose& world = camera.world_from_camera;
  std::vector<RasterLine> lines;
  for (std::size_t n = 0; n < far.size(); ++n) {
    lines.push_back({world.translation, world * far[n], kCameraMark});
    lines.push_back({world * far[n], world * far[(n + 1) % far.size()], kCameraMark});
  }
  const Vec3 roof = (far[0] + far[1]) * 0.5F + Vec3{0, 0.3F * (far[0].y - far[3].y), 0};
  lines.push_back({world * far[0], world * roof, kCameraMark});
  lines.push_back({world * far[1], world * roof, kCameraMark});
  return lines;
}

/// The longest edge of the box around a figure, meters.
float sizeOf(const Figure& figure) {
  const pack_tool::FigureBounds bounds = boundsOf(figure);
  // Marks are drawn also where nothing else is.
  if (bounds.empty()) return 1;
  const Vec3 edges = bounds.max - bounds.min;
  return std::max({edges.x, edges.y, edges.z});
}

float graspRadius(const GraspMark& grasp) { return std::max(grasp.radius, kLeastGraspRadius); }

std::vector<RasterLine> markLines(const Figure& figure) {
  std::vector<RasterLine> lines;
  if (figure.kind != FigureKind::kRobot) return lines;
  const float size = sizeOf(figure);
  for (std::size_t n = 0; n < figure.footprint.size(); ++n) {
    lines.push_back(
        {figure.footprint[n], figure.footprint[(n + 1) % figure.footprint.size()], kFootprintMark});
  }
  if (figure.camera) {
    const auto camera = cameraLines(*figure.camera, kCameraLength * size);
    lines.insert(lines.end(), camera.begin(), camera.end());
  }
  if (figure.grasp) {
    const float half = std::max(graspRadius(*figure.grasp), kGraspCross * size);
    for (const Vec3& arm : {Vec3{half, 0, 0}, Vec3{0, half, 0}, Vec3{0, 0, half}}) {
      const Vec3& center = figure.grasp->center_in_world;
      lines.push_back({center - arm, center + arm, kGraspMark});
    }
  }
  return lines;
}

void drawPart(MeshRaster& raster, const Figure& figure, const FigurePart& part,
              std::span<const float> radii) {
  const bool robot = figure.kind == FigureKind::kRobot;
  if (part.render_model) {
    const RenderMeshes& meshes = *figure.render_meshes;
    raster.drawRenderModel(meshes, meshes.models[*part.render_model], part.world_from_part);
  } else {
    const auto colors = robot ? part.surface.colors : std::span<const std::uint32_t>();
    raster.drawMesh({part.surface.positions, part.surface.corners, colors, kMeshGray},
                    part.world_from_part);
  }
  for (const SetSphere& sphere : part.spheres) {
    const float radius = figure.radii[sphere.radius_index];
    const auto rank = std::ranges::lower_bound(radii, radius) - radii.begin();
    raster.drawSphere({part.world_from_part * sphere.center, radius},
                      sphereColor(static_cast<std::size_t>(rank)));
  }
  if (!part.box) return;
  const auto corners = pack_tool::cornersOf(*part.box);
  for (const auto& [from, to] : pack_tool::kBoxEdges) {
    raster.drawLine({part.world_from_part * corners[static_cast<std::size_t>(from)],
                     part.world_from_part * corners[static_cast<std::size_t>(to)], kBoxEdge});
  }
}

}  // namespace

std::vector<float> radiiOf(std::span<const Figure> figures) {
  std::vector<float> radii;
  for (const Figure& figure : figures) {
    for (const FigurePart& part : figure.parts) {
      for (const SetSphere& sphere : part.spheres) {
        radii.push_back(figure.radii[sphere.radius_index]);
      }
    }
  }
  std::ranges::sort(radii);
  radii.erase(std::unique(radii.begin(), radii.end()), radii.end());
  return radii;
}

double ViewWindow::extent() const { return std::max({width(), height(), kLeastExtent}); }

ViewWindow windowOf(const Figure& figure, const ViewAxes& axes) {
  constexpr double kFar = std::numeric_limits<double>::max();
  ViewWindow window{kFar, -kFar, kFar, -kFar};
  for (const FigurePart& part : figure.parts) {
    const Pose& pose = part.world_from_part;
    for (const std::uint32_t corner : part.surface.corners) {
      include(window, axes, {pose * part.surface.positions[corner], 0});
    }
    if (part.surface.empty() && part.render_model) {
      for (const Vec3& corner : renderBoxOf(figure, part)) include(window, axes, {corner, 0});
    }
    for (const SetSphere& sphere : part.spheres) {
      include(window, axes, {pose * sphere.center, figure.radii[sphere.radius_index]});
    }
    if (!part.box) continue;
    for (const Vec3& corner : pack_tool::cornersOf(*part.box)) {
      include(window, axes, {pose * corner, 0});
    }
  }
  for (const RasterLine& line : markLines(figure)) {
    include(window, axes, {line.from, 0});
    include(window, axes, {line.to, 0});
  }
  return window.low_right > window.high_right ? ViewWindow{} : window;
}

double fittingScale(double meters, int pixels) { return (1 - 2 * kBorder) * pixels / meters; }

void drawFigureView(Image& image, const ViewPlace& place, const Figure& figure,
                    const FigureView& view) {
  const ViewAxes& axes = view.axes;
  const ViewWindow window = windowOf(figure, axes);
  const auto right = static_cast<float>(0.5 * (window.low_right + window.high_right));
  const auto up = static_cast<float>(0.5 * (window.low_up + window.high_up));
  MeshRaster raster(
      {axes, axes.right * right + axes.up * up, view.pixels_per_meter, place.size, place.size});
  if (view.cut) raster.openRooms(*view.cut);
  for (const FigurePart& part : figure.parts) drawPart(raster, figure, part, view.radii);
  for (const RasterLine& line : markLines(figure)) raster.drawLine(line);
  if (figure.kind == FigureKind::kRobot && figure.grasp) {
    raster.drawSphere({figure.grasp->center_in_world, graspRadius(*figure.grasp)}, kGraspMark);
  }
  raster.compose(image, place.left, place.top);
}

}  // namespace galactic::pictures
