#include "render_apartment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <span>

#include "galactic/pose.h"

namespace galactic {
namespace {

using test::RenderModelBuilder;
using test::RenderSurface;
using test::RenderVertex;

constexpr int kRoomsX = 3;
constexpr int kRoomsZ = 2;
/// Meters.
constexpr float kRoom = 4;
constexpr float kHeight = 2.7F;
constexpr float kWall = 0.05F;
constexpr std::uint32_t kLinks = 20;
constexpr std::uint32_t kObjects = 30;
/// Quads along the edges of a patch that fill one cluster.
constexpr int kPatch = 8;
constexpr float kPi = std::numbers::pi_v<float>;

float between(std::mt19937& random, float lo, float hi) {
  const double share = static_cast<double>(random()) / 4294967296.0;
  return lo + static_cast<float>(share) * (hi - lo);
}

/// A surface over the unit square, in quads, patch after patch; quads that `leaveOut` names are
/// left out.
struct Sheet {
  int across = 16;
  int up = 16;
  std::function<RenderVertex(float, float)> at;
  std::function<bool(float, float)> leave_out;
};

void addQuad(RenderModelBuilder& builder, const Sheet& sheet, int i, int j,
             const RenderSurface& surface) {
  const auto vertex = [&](int di, int dj) {
    return sheet.at(static_cast<float>(i + di) / static_cast<float>(sheet.across),
                    static_cast<float>(j + dj) / static_cast<float>(sheet.up));
  };
  const float u = (static_cast<float>(i) + 0.5F) / static_cast<float>(sheet.across);
  const float v = (static_cast<float>(j) + 0.5F) / static_cast<float>(sheet.up);
  if (sheet.leave_out && sheet.leave_out(u, v)) return;
  const RenderVertex a = vertex(0, 0);
  const RenderVertex b = vertex(1, 0);
  const RenderVertex c = vertex(1, 1);
  const RenderVertex d = vertex(0, 1);
  builder.triangle({a, b, c}, surface);
  builder.triangle({a, c, d}, surface);
}

void addSheet(RenderModelBuilder& builder, const Sheet& sheet, const RenderSurface& surface) {
  for (int i0 = 0; i0 < sheet.across; i0 += kPatch) {
    for (int j0 = 0; j0 < sheet.up; j0 += kPatch) {
      for (int i = i0; i < std::min(i0 + kPatch, sheet.across); ++i) {
        for (int j = j0; j < std::min(j0 + kPatch, sheet.up); ++j) {
          addQuad(builder, sheet, i, j, surface);
        }
      }
    }
  }
}

/// A flat sheet from a corner along two edges, seen from the side to which edge_u x edge_v points.
Sheet flat(const Vec3& corner, const Vec3& edge_u, const Vec3& edge_v) {
  return {.across = 24,
          .up = 16,
          .at =
              [=](float u, float v) {
                return RenderVertex{corner + edge_u * u + edge_v * v, 2 * u, 2 * v};
              },
          .leave_out = nullptr};
}

float power(float value, float exponent) {
  return std::copysign(std::pow(std::abs(value), exponent), value);
}

/// A rounded box, or an egg: exponents from 0.1 to 1.
Sheet roundedBox(const Vec3& center, const Vec3& radii, float exponent, int across, int up) {
  return {.across = across,
          .up = up,
          .at =
              [=](float u, float v) {
                const float around = -2 * kPi * u;
                const float polar = kPi * (v - 0.5F);
                const float ring = power(std::cos(polar), exponent);
                return RenderVertex{
                    center + Vec3{radii.x * ring * power(std::cos(around), exponent),
                                  radii.y * power(std::sin(polar), exponent),
                                  radii.z * ring * power(std::sin(around), exponent)},
                    u, v};
              },
          .leave_out = nullptr};
}

std::vector<std::uint32_t> texels(std::mt19937& random) {
  constexpr std::uint32_t kSize = 512;
  std::vector<std::uint32_t> result(std::size_t{kSize} * kSize);
  const auto base = static_cast<std::uint32_t>(random());
  for (std::uint32_t n = 0; n < result.size(); ++n) {
    const std::uint32_t x = n % kSize;
    const std::uint32_t y = n / kSize;
    const std::uint32_t stripe = (x / 32 + y / 16) % 2 * 0x202020;
    result[n] =
        0xFF000000U | (((base & 0x7F7F7FU) + stripe + (x ^ y) % 32 * 0x010101U) & 0xFFFFFFU);
  }
  return result;
}

/// A wall with a door in the middle of its length.
void addWall(RenderModelBuilder& builder, const Vec3& corner, const Vec3& along,
             std::uint16_t material) {
  Sheet wall = flat(corner, along, {0, kHeight, 0});
  wall.leave_out = [](float u, float v) { return std::abs(u - 0.5F) < 0.13F && v < 0.76F; };
  addSheet(builder, wall, {.material = material});
}

void addRoom(RenderModelBuilder& builder, std::mt19937& random, const Vec3& corner,
             std::span<const std::uint16_t> materials) {
  const float low = kWall;
  const float high = kRoom - kWall;
  const auto at = [&](float x, float y, float z) { return corner + Vec3{x, y, z}; };
  const float length = high - low;
  const auto pick = [&] { return materials[random() % materials.size()]; };
  addSheet(builder, flat(at(low, 0, low), {0, 0, length}, {length, 0, 0}), {.material = pick()});
  addSheet(builder, flat(at(low, kHeight, low), {length, 0, 0}, {0, 0, length}),
           {.material = pick()});
  const std::uint16_t wall = pick();
  addWall(builder, at(low, 0, low), {length, 0, 0}, wall);
  addWall(builder, at(high, 0, low), {0, 0, length}, wall);
  addWall(builder, at(high, 0, high), {-length, 0, 0}, wall);
  addWall(builder, at(low, 0, high), {0, 0, -length}, wall);
  for (int n = 0; n < 8; ++n) {
    const Vec3 radii{between(random, 0.15F, 0.6F), between(random, 0.2F, 0.8F),
                     between(random, 0.15F, 0.6F)};
    const Vec3 place =
        at(between(random, 0.6F, kRoom - 0.6F), radii.y, between(random, 0.6F, kRoom - 0.6F));
    addSheet(builder, roundedBox(place, radii, between(random, 0.1F, 1), 24, 16),
             {.material = pick()});
  }
}

Vec3 placeInRooms(std::mt19937& random, float height) {
  const float room_x = static_cast<float>(random() % kRoomsX) * kRoom;
  const float room_z = static_cast<float>(random() % kRoomsZ) * kRoom;
  return {room_x + between(random, 0.4F, kRoom - 0.4F), height,
          room_z + between(random, 0.4F, kRoom - 0.4F)};
}

Quat turned(float yaw) { return {0, std::sin(yaw / 2), 0, std::cos(yaw / 2)}; }

}  // namespace

RenderModelBuilder apartmentMeshes() {
  std::mt19937 random(3);
  RenderModelBuilder builder(1.0F / 4096);
  std::vector<std::uint16_t> materials;
  for (int n = 0; n < 24; ++n) {
    materials.push_back(builder.material(0, builder.texture(512, texels(random))));
  }
  builder.model();
  for (int x = 0; x < kRoomsX; ++x) {
    for (int z = 0; z < kRoomsZ; ++z) {
      addRoom(builder, random, {static_cast<float>(x) * kRoom, 0, static_cast<float>(z) * kRoom},
              materials);
    }
  }
  for (std::uint32_t n = 0; n < kLinks + kObjects; ++n) {
    builder.model();
    const bool link = n < kLinks;
    const Vec3 radii = link ? Vec3{0.06F, 0.1F, 0.06F}
                            : Vec3{between(random, 0.03F, 0.1F), between(random, 0.04F, 0.12F),
                                   between(random, 0.03F, 0.1F)};
    addSheet(builder, roundedBox({}, radii, between(random, 0.2F, 1), link ? 12 : 16, 12),
             {.material = materials[random() % materials.size()]});
  }
  builder.finish();
  return builder;
}

std::vector<RenderInstance> furnishedApartment(const RenderLibrary& library, std::mt19937& random) {
  std::vector<RenderInstance> instances = {{0, {}}};
  instances.reserve(library.modelCount());
  const Vec3 base = placeInRooms(random, 0.1F);
  for (std::uint32_t n = 1; n < library.modelCount(); ++n) {
    // The robot is a column of links, leaning forward.
    const float share = static_cast<float>(n) / kLinks;
    const Vec3 place = n <= kLinks
                           ? base + Vec3{0.3F * std::sin(4 * share), 0.1F + share, 0.2F * share}
                           : placeInRooms(random, between(random, 0.1F, 1.1F));
    instances.push_back({n, rigidTransform({place, turned(between(random, -kPi, kPi))})});
  }
  return instances;
}

std::vector<RenderInstance> everyModel(const RenderLibrary& library) {
  std::vector<RenderInstance> instances(library.modelCount());
  for (std::uint32_t n = 0; n < instances.size(); ++n) instances[n].model = n;
  return instances;
}

RenderCamera cameraInApartment(std::mt19937& random) {
  const float pitch = between(random, -0.35F, 0.05F);
  const Quat down{0, 0, std::sin(pitch / 2), std::cos(pitch / 2)};
  const Quat yaw = turned(between(random, -kPi, kPi));
  return {rigidTransform({placeInRooms(random, 1.2F), yaw * down}), kPi / 2};
}

}  // namespace galactic
