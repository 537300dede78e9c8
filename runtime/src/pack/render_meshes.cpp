#include "galactic/render_meshes.h"

#include <algorithm>

#include "galactic/render_library.h"
#include "pack/schema_values.h"

namespace galactic {
namespace {

static_assert(sizeof(RenderCluster) == sizeof(schema::RenderCluster));

const schema::RenderMeshes* storedMeshes(const PackFile& pack) {
  switch (pack.kind()) {
    case PackKind::kScene:
      return pack.root().asset_as_Scene()->render_meshes();
    case PackKind::kObjects:
      return pack.root().asset_as_ObjectSet()->render_meshes();
    case PackKind::kRobot:
      return pack.root().asset_as_Robot()->render_meshes();
    default:
      return nullptr;
  }
}

bool hasKindWithMeshes(const PackFile& pack) {
  return pack.kind() == PackKind::kScene || pack.kind() == PackKind::kObjects ||
         pack.kind() == PackKind::kRobot;
}

RenderModel modelFrom(const schema::RenderModel& stored) {
  return {.part = stored.part(),
          .step = stored.step(),
          .first_cluster = stored.first_cluster(),
          .cluster_count = stored.cluster_count(),
          .first_block = stored.first_block(),
          .bounds_min = detail::fromSchema(stored.bounds()->min()),
          .bounds_max = detail::fromSchema(stored.bounds()->max()),
          .source_triangles = stored.source_triangles(),
          .triangles = stored.triangles(),
          .largest_error = stored.largest_error()};
}

RenderTexture textureFrom(const schema::RenderTexture& stored,
                          std::span<const std::uint8_t> texels) {
  const auto format = static_cast<TexelFormat>(stored.format());
  return {.name = detail::fromSchema(stored.name()),
          .size = stored.size(),
          .format = format,
          .texels = texels.subspan(stored.first_byte(), textureBytes(stored.size(), format))};
}

/// Fills the textures of `meshes`. Returns where each stored one went, -1 for a missing one.
std::vector<std::int32_t> takeTextures(const schema::RenderMeshes& stored,
                                       const SharedTextures& shared, RenderMeshes& meshes) {
  const auto texels = detail::inPlace<std::uint8_t>(stored.texels());
  std::vector<std::int32_t> place;
  place.reserve(stored.textures()->size());
  for (const schema::RenderTexture* texture : *stored.textures()) {
    const auto next = static_cast<std::int32_t>(meshes.textures.size());
    const schema::Hash128* hash = texture->shared();
    const RenderTexture* elsewhere =
        hash == nullptr ? nullptr : shared.find(hash->low(), hash->high());
    if (hash == nullptr) {
      meshes.textures.push_back(textureFrom(*texture, texels));
    } else if (elsewhere != nullptr) {
      meshes.textures.push_back(*elsewhere);
    } else {
      meshes.missing_textures.push_back(
          {detail::fromSchema(texture->name()), hash->low(), hash->high()});
      place.push_back(-1);
      continue;
    }
    place.push_back(next);
  }
  return place;
}

}  // namespace

std::optional<std::uint32_t> RenderMeshes::modelOf(std::uint32_t part) const {
  const auto found = std::ranges::lower_bound(models, part, {}, &RenderModel::part);
  if (found == models.end() || found->part != part || found->cluster_count == 0) {
    return std::nullopt;
  }
  return static_cast<std::uint32_t>(found - models.begin());
}

std::size_t textureBytes(std::uint32_t size, TexelFormat format) {
  std::size_t bytes = 0;
  for (std::size_t edge = size; edge > 0; edge /= 2) {
    const std::size_t blocks = (edge + 3) / 4;
    bytes += format == TexelFormat::kBc1 ? blocks * blocks * 8 : edge * edge * 4;
  }
  return bytes;
}

Result<std::optional<RenderMeshes>> renderMeshesOf(const PackFile& pack) {
  return renderMeshesOf(pack, {});
}

Result<std::optional<RenderMeshes>> renderMeshesOf(const PackFile& pack,
                                                   const SharedTextures& shared) {
  if (!hasKindWithMeshes(pack)) {
    return fail(ErrorCode::kInvalidInput, pack.where(),
                "is a pack of kind " + packKindName(pack.kind()) +
                    ", expected a scene, objects or a robot: only they have something to draw");
  }
  const schema::RenderMeshes* stored = storedMeshes(pack);
  if (stored == nullptr) return std::optional<RenderMeshes>();
  RenderMeshes meshes;
  meshes.models.reserve(stored->models()->size());
  for (const schema::RenderModel* model : *stored->models()) {
    meshes.models.push_back(modelFrom(*model));
  }
  meshes.clusters = detail::inPlace<RenderCluster>(stored->clusters());
  meshes.cluster_bounds = detail::inPlace<float>(stored->cluster_bounds());
  meshes.vertices = detail::inPlace<std::uint16_t>(stored->vertices());
  meshes.colors = detail::inPlace<std::uint32_t>(stored->colors());
  meshes.triangles = detail::inPlace<std::uint8_t>(stored->triangles());
  const std::vector<std::int32_t> place = takeTextures(*stored, shared, meshes);
  for (const schema::RenderMaterial* material : *stored->materials()) {
    const std::int32_t texture = material->texture();
    meshes.materials.push_back(
        {.name = detail::fromSchema(material->name()),
         .color = material->color(),
         .texture = texture < 0 ? texture : place[static_cast<std::size_t>(texture)],
         .alpha_cutoff = material->alpha_cutoff()});
  }
  meshes.semantics = detail::namesOf(*stored->semantics());
  return std::optional<RenderMeshes>(std::move(meshes));
}

}  // namespace galactic
