#include "asset/object_journal.h"

#include <algorithm>
#include <bit>
#include <type_traits>
#include <utility>

#include "cache/file_digests.h"
#include "import/asset_transfer.h"
#include "import/transfer_archive.h"

namespace galactic::bake {

template <class Archive>
void transferFields(Archive& archive, Is<ImportStatistics> auto& imported) {
  archive(imported.format, imported.meshes, imported.instances, imported.counts,
          imported.triangles);
}

template <class Archive>
void transferFields(Archive& archive, Is<SphereSet> auto& set) {
  archive(set.spheres, set.quality, set.guaranteed_gap, set.guaranteed_protrusion,
          set.meets_tolerances);
}

template <class Archive>
void transferFields(Archive& archive, Is<Surface> auto& surface) {
  archive(surface.positions, surface.triangles, surface.colors);
}

template <class Archive>
void transferFields(Archive& archive, Is<BakedMaterial> auto& material) {
  archive(material.name, material.color, material.texture, material.alpha_cutoff);
}

template <class Archive>
void transferFields(Archive& archive, Is<BakedTexture> auto& texture) {
  archive(texture.name, texture.size, texture.format, texture.first_byte, texture.hash_low,
          texture.hash_high);
}

template <class Archive>
void transferFields(Archive& archive, Is<BakedMaterials> auto& all) {
  archive(all.materials, all.textures, all.texels, all.shared, all.source_bytes, all.warnings);
}

template <class Archive>
void transferFields(Archive& archive, Is<BakedRenderMeshes> auto& meshes) {
  archive(meshes.models, meshes.clusters, meshes.cluster_bounds, meshes.vertices, meshes.colors,
          meshes.triangles, meshes.materials, meshes.semantics, meshes.source_vertices,
          meshes.source_bytes);
}

template <class Archive>
void transferFields(Archive& archive, Is<BakedObject> auto& object) {
  archive(object.name, object.imported, object.bounds, object.box, object.stable_poses,
          object.hull_planes, object.eps, object.tau, object.spheres, object.authored_spheres,
          object.surface, object.times, object.warnings);
  bool is_drawn = object.render_meshes.has_value();
  archive(is_drawn);
  if constexpr (!std::is_const_v<std::remove_reference_t<decltype(object)>>) {
    if (is_drawn) object.render_meshes.emplace();
  }
  if (is_drawn) archive(*object.render_meshes);
}

template <class Archive>
void transferFields(Archive& archive, Is<FinishedObject> auto& finished) {
  archive(finished.read, finished.import_seconds, finished.object);
}

namespace {

bool isSound(const BakedMaterials& all) {
  constexpr std::uint32_t kWidest = 4096;
  return std::ranges::all_of(all.materials,
                             [&](const BakedMaterial& one) {
                               return one.texture < static_cast<std::int64_t>(all.textures.size());
                             }) &&
         std::ranges::all_of(all.textures, [&](const BakedTexture& one) {
           return std::has_single_bit(one.size) && one.size <= kWidest &&
                  one.first_byte + textureBytes(one.size, one.format) <= all.texels.size();
         });
}

bool isSound(const BakedRenderMeshes& meshes) {
  const std::size_t vertices = meshes.vertices.size() / kVertexRows;
  return isSound(meshes.materials) && (meshes.colors.empty() || meshes.colors.size() == vertices) &&
         std::ranges::all_of(meshes.clusters, [&](const RenderCluster& one) {
           return one.material < meshes.materials.materials.size() &&
                  one.semantic < meshes.semantics.size() &&
                  std::size_t{one.first_vertex} + one.vertex_count <= vertices;
         });
}

/// Whether all counts and indices are consistent, because anybody could have written the journal.
/// The rest is checked when the pack is opened.
bool isSound(const BakedObject& object, std::size_t radii) {
  const Surface& surface = object.surface;
  return std::ranges::all_of(object.spheres.spheres,
                             [&](const SetSphere& one) { return one.radius_index < radii; }) &&
         std::ranges::all_of(surface.triangles,
                             [&](const Triangle& one) {
                               return std::ranges::max(one) < surface.positions.size();
                             }) &&
         (surface.colors.empty() || surface.colors.size() == surface.positions.size()) &&
         (!object.render_meshes || isSound(*object.render_meshes));
}

}  // namespace

ObjectJournal::ObjectJournal(std::unique_ptr<Journal> journal, std::size_t radii)
    : journal_(std::move(journal)), radii_(radii) {
  if (journal_ == nullptr) return;
  for (const std::string_view record : journal_->records()) {
    TransferReader reader(std::as_bytes(std::span(record)));
    std::string name;
    reader(name);
    if (reader.good()) records_.insert_or_assign(std::move(name), record);
  }
}

std::optional<FinishedObject> ObjectJournal::recall(const ObjectInput& input) const {
  const auto found = records_.find(input.name);
  if (found == records_.end()) return std::nullopt;
  TransferReader reader(std::as_bytes(std::span(found->second)));
  std::string name;
  std::string file;
  FinishedObject finished;
  reader(name, file, finished);
  const bool is_it = reader.good() && reader.atEnd() && finished.object.name == input.name &&
                     file == input.path.filename() && isSound(finished.object, radii_) &&
                     FileDigests().areAsRead(finished.read, input.path.parent_path());
  if (!is_it) return std::nullopt;
  return finished;
}

Result<void> ObjectJournal::add(const ObjectInput& input, const FinishedObject& finished) const {
  if (journal_ == nullptr) return {};
  return journal_->add(bytesOf(input.name, input.path.filename().string(), finished));
}

void ObjectJournal::remove() const {
  if (journal_ != nullptr) journal_->remove();
}

}  // namespace galactic::bake
