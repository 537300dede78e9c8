#include "check/render_check.h"

#include <bit>
#include <cmath>

#include "check/common_check.h"
#include "check/offence.h"
#include "check/render_cluster_check.h"
#include "check/texture_check.h"
#include "layout/render_layout.h"
#include "pack/schema_values.h"

namespace galactic::detail {
namespace {

/// Materials and semantics have 16-bit numbers.
constexpr std::size_t kMostNumbers = 65536;
constexpr std::size_t kTexelAlignment = 32;
/// The steps of lattices are powers of two between these, meters.
constexpr float kLeastStep = 0x1p-20F;
constexpr float kMostStep = 1.0F;

bool isPowerOfTwo(float value) {
  int exponent = 0;
  return std::frexp(value, &exponent) == 0.5F;
}

class RenderChecker {
 public:
  RenderChecker(const schema::RenderMeshes& meshes, std::size_t parts, const std::string& where)
      : meshes_(meshes), parts_(parts), offence_(where + ".render_meshes") {
    pools_.bounds = inPlace<float>(meshes.cluster_bounds());
    pools_.vertices = inPlace<std::uint16_t>(meshes.vertices());
    pools_.colors = inPlace<std::uint32_t>(meshes.colors());
    pools_.triangles = inPlace<std::uint8_t>(meshes.triangles());
    pools_.materials = meshes.materials()->size();
    pools_.semantics = meshes.semantics()->size();
    clusters_ = inPlace<RenderCluster>(meshes.clusters());
  }

  Result<void> run() {
    checkSizes();
    checkTextures();
    checkMaterials();
    for (flatbuffers::uoffset_t n = 0; n < meshes_.models()->size() && !offence_.found(); ++n) {
      checkModel(n);
    }
    if (!offence_.found()) checkEnds();
    return offence_.result();
  }

 private:
  void checkSizes() {
    offence_.require(pools_.semantics >= 1 && pools_.semantics <= kMostNumbers, "semantics",
                     "has {} names, expected 1 to {}", pools_.semantics, kMostNumbers);
    offence_.require(pools_.materials <= kMostNumbers, "materials",
                     "has {} materials, expected at most {}", pools_.materials, kMostNumbers);
    offence_.require(pools_.bounds.size() % (kBoundsRows * kRenderLanes) == 0, "cluster_bounds",
                     "has {} elements, expected blocks of {}", pools_.bounds.size(),
                     kBoundsRows * kRenderLanes);
    offence_.require(pools_.vertices.size() % (kVertexRows * kRenderLanes) == 0, "vertices",
                     "has {} elements, expected blocks of {}", pools_.vertices.size(),
                     kVertexRows * kRenderLanes);
    offence_.require(pools_.triangles.size() % (kTriangleRows * kRenderLanes) == 0, "triangles",
                     "has {} elements, expected blocks of {}", pools_.triangles.size(),
                     kTriangleRows * kRenderLanes);
    const std::size_t vertices = pools_.vertices.size() / kVertexRows;
    offence_.require(pools_.colors.empty() || pools_.colors.size() == vertices, "colors",
                     "has {} elements, expected {}, one per vertex, or none", pools_.colors.size(),
                     vertices);
  }

  void checkTextures() {
    const std::size_t bytes = meshes_.texels()->size();
    std::size_t next_byte = 0;
    for (flatbuffers::uoffset_t n = 0; n < meshes_.textures()->size() && !offence_.found(); ++n) {
      const schema::RenderTexture& texture = *meshes_.textures()->Get(n);
      const std::string field = fmt::format("textures[{}]", n);
      requireTextureForm(texture, field + ".", offence_);
      if (texture.shared() != nullptr) {
        offence_.require(texture.first_byte() == 0, field + ".first_byte",
                         "is {} of a shared texture, expected 0", texture.first_byte());
        continue;
      }
      offence_.require(texture.first_byte() % kTexelAlignment == 0, field + ".first_byte",
                       "is {}, expected a multiple of {}", texture.first_byte(), kTexelAlignment);
      // Without overlaps, the texels unpacked for drawing are limited by the size of the pack.
      offence_.require(texture.first_byte() >= next_byte, field + ".first_byte",
                       "is {}, expected {} or more, behind the texture before",
                       texture.first_byte(), next_byte);
      if (offence_.found()) return;
      const std::size_t needed =
          textureBytes(texture.size(), static_cast<TexelFormat>(texture.format()));
      offence_.require(texture.first_byte() + needed <= bytes, field + ".first_byte",
                       "is {} with {} bytes from there on, expected within the {} of texels",
                       texture.first_byte(), needed, bytes);
      next_byte = texture.first_byte() + needed;
    }
  }

  void checkMaterials() {
    const auto textures = static_cast<std::int64_t>(meshes_.textures()->size());
    for (flatbuffers::uoffset_t n = 0; n < pools_.materials && !offence_.found(); ++n) {
      const schema::RenderMaterial& material = *meshes_.materials()->Get(n);
      const std::string field = fmt::format("materials[{}]", n);
      offence_.require(material.texture() >= -1 && material.texture() < textures,
                       field + ".texture", "is {}, expected one of the {} textures, or -1",
                       material.texture(), textures);
      offence_.require(material.alpha_cutoff() >= 0 && material.alpha_cutoff() <= 1,
                       field + ".alpha_cutoff", "is {}, expected 0 to 1", material.alpha_cutoff());
    }
  }

  void checkModel(flatbuffers::uoffset_t n) {
    const schema::RenderModel& stored = *meshes_.models()->Get(n);
    const std::string field = fmt::format("models[{}]", n);
    const std::int64_t previous = n == 0 ? -1 : std::int64_t{meshes_.models()->Get(n - 1)->part()};
    offence_.require(stored.part() > previous && stored.part() < parts_, field + ".part",
                     "is {} after {}, expected ascending numbers under {}", stored.part(), previous,
                     parts_);
    offence_.require(
        stored.step() > kLeastStep && stored.step() <= kMostStep && isPowerOfTwo(stored.step()),
        field + ".step", "is {} m, expected a power of two over {} and at most {} m", stored.step(),
        kLeastStep, kMostStep);
    offence_.require(stored.first_cluster() == next_cluster_, field + ".first_cluster",
                     "is {}, expected {}, behind the model before", stored.first_cluster(),
                     next_cluster_);
    offence_.require(stored.cluster_count() <= clusters_.size() - next_cluster_,
                     field + ".cluster_count", "is {}, expected at most the {} that are left",
                     stored.cluster_count(), clusters_.size() - next_cluster_);
    offence_.require(stored.first_block() == next_block_, field + ".first_block",
                     "is {}, expected {}, behind the model before", stored.first_block(),
                     next_block_);
    if (offence_.found()) return;
    const std::size_t lanes = wholeLanes(stored.cluster_count());
    const std::size_t blocks = pools_.bounds.size() / (kBoundsRows * kRenderLanes);
    offence_.require(lanes / kRenderLanes <= blocks - next_block_, field + ".cluster_count",
                     "is {}, expected no more than the {} blocks of bounds that are left hold",
                     stored.cluster_count(), blocks - next_block_);
    offence_.require(checkBounds(stored.bounds(), fmt::format("{}.{}", offence_.where(), field)));
    offence_.require(stored.largest_error() >= 0 && isCoordinate(stored.largest_error()),
                     field + ".largest_error", "is {} m, expected 0 to {} m",
                     stored.largest_error(), kFarthest);
    if (offence_.found()) return;
    checkClusters(stored, field);
  }

  void checkClusters(const schema::RenderModel& stored, const std::string& field) {
    RenderModel model;
    model.step = stored.step();
    model.bounds_min = fromSchema(stored.bounds()->min());
    model.bounds_max = fromSchema(stored.bounds()->max());
    std::uint64_t triangles = 0;
    place_.lane = next_block_ * kRenderLanes;
    for (std::size_t n = 0; n < stored.cluster_count() && !offence_.found(); ++n) {
      const RenderCluster& cluster = clusters_[next_cluster_ + n];
      auto checked = checkCluster(cluster, model, pools_, place_);
      if (!checked) {
        checked.error().where = fmt::format("{}.clusters[{}]{}", offence_.where(),
                                            next_cluster_ + n, checked.error().where);
        return offence_.require(std::move(checked));
      }
      place_.first_vertex += wholeLanes(cluster.vertex_count);
      place_.first_triangle += wholeLanes(cluster.triangle_count);
      ++place_.lane;
      triangles += cluster.triangle_count;
    }
    offence_.require(stored.triangles() == triangles, field + ".triangles",
                     "is {}, expected the {} of its clusters", stored.triangles(), triangles);
    checkEmptyLanes();
    next_cluster_ += stored.cluster_count();
    next_block_ += wholeLanes(stored.cluster_count()) / kRenderLanes;
  }

  /// Culling by eight must not find a cluster in an unused lane.
  void checkEmptyLanes() {
    for (; place_.lane % kRenderLanes != 0; ++place_.lane) {
      for (std::size_t row = 0; row < kBoundsRows; ++row) {
        const float value = pools_.bounds[pooledAt(place_.lane, row, kBoundsRows)];
        const float wanted = row >= kHalfExtentRow && row <= kRadiusRow ? kNoCluster : 0;
        offence_.require(
            value == wanted, fmt::format("cluster_bounds[{}]", place_.lane / kRenderLanes),
            "has {} in row {} of a lane without a cluster, expected {}", value, row, wanted);
      }
    }
  }

  /// Checks that nothing is left over.
  void checkEnds() {
    offence_.require(next_cluster_ == clusters_.size(), "clusters",
                     "has {} elements, expected the {} of the models", clusters_.size(),
                     next_cluster_);
    const std::size_t blocks = pools_.bounds.size() / (kBoundsRows * kRenderLanes);
    offence_.require(next_block_ == blocks, "cluster_bounds",
                     "has {} blocks, expected the {} of the models", blocks, next_block_);
    offence_.require(place_.first_vertex * kVertexRows == pools_.vertices.size(), "vertices",
                     "has {} elements, expected the {} of the clusters", pools_.vertices.size(),
                     place_.first_vertex * kVertexRows);
    offence_.require(place_.first_triangle * kTriangleRows == pools_.triangles.size(), "triangles",
                     "has {} elements, expected the {} of the clusters", pools_.triangles.size(),
                     place_.first_triangle * kTriangleRows);
  }

  const schema::RenderMeshes& meshes_;
  std::size_t parts_;
  Offence offence_;
  RenderPools pools_;
  std::span<const RenderCluster> clusters_;
  ClusterPlace place_;
  std::size_t next_cluster_ = 0;
  std::size_t next_block_ = 0;
};

}  // namespace

Result<void> checkRenderMeshes(const schema::RenderMeshes& meshes, std::size_t parts,
                               const std::string& where) {
  return RenderChecker(meshes, parts, where).run();
}

}  // namespace galactic::detail
