// Before `auto` takes a CUDA device, the device has to prove itself with a small scene that has
// triangles of every kind: its images must be those of the `soft` renderer.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "layout/render_mesh_builder.h"
#include "render/render_engine.h"
#include "support/try.h"

namespace galactic::render {
namespace {

constexpr std::uint32_t kProofEdge = 64;

/// Small triangles of many colors, like the shards of a bowl around the X axis.
RenderSurface shards() {
  RenderSurface surface;
  surface.semantic = 1;
  surface.two_sided = true;
  constexpr std::uint32_t kShards = 100;
  for (std::uint32_t n = 0; n < kShards; ++n) {
    const auto at = [n](std::uint32_t factor) {
      return static_cast<float>(n * factor % kShards) / static_cast<float>(kShards);
    };
    const Vec3 p{2 + at(17), at(37) - 0.5F, at(61) - 0.5F};
    const std::uint32_t color = 0xFF000000U | n * 0x010305U;
    surface.vertices.push_back({p, at(7), at(11), color});
    surface.vertices.push_back({{p.x + at(3), p.y + 0.25F, p.z}, at(13), at(19), ~color});
    surface.vertices.push_back({{p.x, p.y, p.z + 0.25F}, at(23), at(29), color});
    for (std::uint32_t corner = 0; corner < 3; ++corner) surface.corners.push_back(3 * n + corner);
  }
  return surface;
}

/// A floor that begins behind the camera, and a wall behind everything, wider than the image.
RenderSurface room() {
  RenderSurface surface;
  surface.material = 1;
  surface.two_sided = true;
  surface.vertices = {{{-1, -0.5F, -12}, 0, 0}, {{-1, -0.5F, 12}, 5, 0}, {{5, -0.5F, 12}, 5, 5},
                      {{5, -0.5F, -12}, 0, 5},  {{5, 4, -12}, 0, 9},     {{5, 4, 12}, 5, 9}};
  surface.corners = {0, 1, 2, 0, 2, 3, 3, 2, 5, 3, 5, 4};
  return surface;
}

Result<RenderMeshStorage> proofMeshes(const std::vector<std::uint8_t>& texels) {
  RenderMeshSource source;
  source.parts.push_back({.surfaces = {shards(), room()}});
  source.materials = {{.name = "plain"}, {.name = "textured", .texture = 0, .alpha_cutoff = 0.2F}};
  source.textures = {{.name = "noise", .size = 8, .texels = texels}};
  source.semantics = {"room", "shards"};
  return buildRenderMeshes(source);
}

struct ProofImages {
  std::vector<std::uint8_t> color =
      std::vector<std::uint8_t>(std::size_t{4} * kProofEdge * kProofEdge);
  std::vector<float> depth = std::vector<float>(std::size_t{kProofEdge} * kProofEdge);
  std::vector<std::uint32_t> semantics =
      std::vector<std::uint32_t>(std::size_t{kProofEdge} * kProofEdge);

  friend bool operator==(const ProofImages&, const ProofImages&) = default;
};

ProofImages drawProof(RenderEngine& engine) {
  const std::array<RenderInstance, 2> instances{RenderInstance{0, {}},
                                                RenderInstance{0, {.origin = {0.3F, 0.1F, -0.2F}}}};
  const RenderView view{.camera = {}, .instances = instances};
  ProofImages images;
  engine.begin({&view, 1}, {images.color, images.depth, images.semantics});
  engine.end();
  return images;
}

}  // namespace

Result<void> proveCuda(const RenderOptions& wanted) {
  std::vector<std::uint8_t> texels(textureBytes(8, TexelFormat::kRgba8));
  for (std::size_t n = 0; n < texels.size(); ++n) texels[n] = static_cast<std::uint8_t>(n * 89);
  ASSIGN_OR_RETURN(const RenderMeshStorage meshes, proofMeshes(texels));
  RenderLibrary library;
  library.add(meshes.view());
  RenderOptions options;
  options.width = options.height = kProofEdge;
  options.semantics = true;
  options.threads = 1;
  options.device = wanted.device;
  ASSIGN_OR_RETURN(const auto cuda, makeCudaEngine(library, options));
  ASSIGN_OR_RETURN(const auto soft, makeSoftEngine(library, options));
  if (drawProof(*cuda) == drawProof(*soft)) return {};
  return fail(ErrorCode::kInternal, "render backend cuda",
              cuda->description() + " gives other images than the processor");
}

}  // namespace galactic::render
