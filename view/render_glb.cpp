#include "view/render_glb.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "layout/render_texels.h"
#include "pictures/png_file.h"
#include "support/try.h"
#include "view/render_surfaces.h"

namespace galactic {

namespace {

/// What the vertices of a surface have besides positions.
struct VertexContent {
  bool uvs = false;
  bool colors = false;
};

/// The vertices of a surface as GLB files have them.
struct VertexLists {
  std::vector<Vec3> positions;
  std::vector<std::array<float, 2>> uvs;
  std::vector<std::uint32_t> colors;

  VertexLists(const RenderSurface& surface, const VertexContent& content) {
    positions.reserve(surface.vertices.size());
    uvs.reserve(content.uvs ? surface.vertices.size() : 0);
    colors.reserve(content.colors ? surface.vertices.size() : 0);
    for (const RenderVertex& vertex : surface.vertices) {
      positions.push_back(vertex.position);
      if (content.uvs) uvs.push_back({vertex.u, vertex.v});
      if (content.colors) colors.push_back(vertex.color);
    }
  }
};

}  // namespace

Result<std::size_t> RenderGlbWriter::texture(std::size_t number) {
  const auto [found, added] = textures_.try_emplace(number, 0);
  if (!added) return found->second;
  const RenderTexture& texture = meshes_.textures[number];
  std::vector<std::uint32_t> texels = decodedTexels(texture);
  texels.resize(std::size_t{texture.size} * texture.size);
  const auto edge = static_cast<int>(texture.size);
  ASSIGN_OR_RETURN(const auto png,
                   pictures::encodePng({.width = edge, .height = edge, .pixels = texels}));
  found->second = file_.addTexture(texture.name, png);
  return found->second;
}

Result<std::size_t> RenderGlbWriter::material(const MaterialKey& key) {
  const auto [found, added] = materials_.try_emplace(key, 0);
  if (!added) return found->second;
  const RenderMaterial& stored = meshes_.materials[key.first];
  GlbMaterial material;
  material.name = stored.name;
  material.unlit = true;
  material.two_sided = key.second;
  material.alpha_cutoff = stored.alpha_cutoff;
  if (stored.texture >= 0) {
    auto number = texture(static_cast<std::size_t>(stored.texture));
    if (!number) return number;
    material.texture = *number;
  } else {
    material.color = linearColor(stored.color);
    // Whether a plain color is there is decided by the cut-off, not by blending.
    if (material.alpha_cutoff == 0) material.color[3] = 1;
  }
  found->second = file_.addMaterial(material);
  return found->second;
}

Result<void> RenderGlbWriter::write(const RenderModel& model, const std::string& name,
                                    std::size_t parent) {
  const std::vector<RenderSurface> surfaces = surfacesOf(meshes_, model);
  if (surfaces.empty()) return {};
  const bool alone = surfaces.front().semantic == surfaces.back().semantic;
  for (auto from = surfaces.begin(); from != surfaces.end();) {
    const std::uint16_t semantic = from->semantic;
    const auto to = std::find_if(from, surfaces.end(), [semantic](const RenderSurface& surface) {
      return surface.semantic != semantic;
    });
    const std::string node = alone ? name : std::string(meshes_.semantics[semantic]);
    std::vector<GlbPrimitive> primitives;
    std::vector<VertexLists> lists;
    lists.reserve(static_cast<std::size_t>(to - from));
    primitives.reserve(lists.capacity());
    for (; from != to; ++from) {
      ASSIGN_OR_RETURN(const auto number, material({from->material, from->two_sided}));
      const VertexContent content{.uvs = meshes_.materials[from->material].texture >= 0,
                                  .colors = !meshes_.colors.empty()};
      const VertexLists& list = lists.emplace_back(*from, content);
      primitives.push_back({.positions = list.positions,
                            .uvs = list.uvs,
                            .colors = list.colors,
                            .corners = from->corners,
                            .material = number});
    }
    const std::size_t mesh = file_.addMesh(node, primitives);
    file_.addNode({.name = node, .mesh = mesh, .parent = parent});
  }
  return {};
}

}  // namespace galactic
