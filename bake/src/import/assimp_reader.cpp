#include "import/assimp_reader.h"

#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

#include "common/lower_case.h"
#include "import/affine.h"
#include "import/assimp_reader_files.h"
#include "import/assimp_reader_looks.h"
#include "import/assimp_reader_wraps.h"
#include "import/axis_convention.h"
#include "import/checks/content_check.h"
#include "import/polygon_triangulation.h"
#include "import/readable_gltf.h"
#include "import/source_files.h"
#include "import/used_vertices.h"
#include "support/files/mapped_file.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// What we make of a reader's name.
struct Format {
  std::string_view reader;
  std::string_view name;
  AxisConvention convention;
};

constexpr AxisConvention statedBy(UpAxis up, std::string_view by) {
  return {.up = {up, by}, .meters = {1.0, by}};
}

constexpr std::string_view kColladaReader = "Collada Importer";
constexpr std::string_view kFbxReader = "Autodesk FBX Importer";

constexpr std::array kFormats{
    Format{kGltf2Reader, "glTF 2.0", statedBy(UpAxis::kY, "glTF convention")},
    Format{"glTF Importer", "glTF 1.0", statedBy(UpAxis::kY, "glTF convention")},
    Format{kObjReader, "Wavefront OBJ", statedBy(UpAxis::kY, "OBJ convention")},
    Format{kPlyReader, "Stanford PLY", statedBy(UpAxis::kZ, "PLY convention")},
    Format{"Stereolithography (STL) Importer", "STL", statedBy(UpAxis::kZ, "STL convention")},
    Format{kColladaReader, "COLLADA", statedBy(UpAxis::kY, kByFile)},
    Format{kFbxReader, "Autodesk FBX", statedBy(UpAxis::kY, kByFile)},
};

/// The reader that was chosen for the file; null if the library does not report it.
const aiImporterDesc* readerOf(const Assimp::Importer& importer) {
  const int index = importer.GetPropertyInteger("importerIndex", -1);
  return index < 0 ? nullptr : importer.GetImporterInfo(static_cast<std::size_t>(index));
}

/// Whether the reader is meant for files of this name: if none of those accepts the content, the
/// library takes any other reader that does.
bool isForName(const aiImporterDesc& reader, const std::filesystem::path& path) {
  const std::string extension = lowerCase(path.extension().string().substr(1));
  return fmt::format(" {} ", reader.mFileExtensions).find(" " + extension + " ") !=
         std::string::npos;
}

Format formatOf(const Assimp::Importer& importer) {
  const aiImporterDesc* description = readerOf(importer);
  const std::string_view reader = description == nullptr ? "unknown" : description->mName;
  const auto* known = std::find_if(kFormats.begin(), kFormats.end(),
                                   [&](const Format& format) { return format.reader == reader; });
  if (known != kFormats.end()) return *known;
  return {.reader = reader, .name = reader, .convention = statedBy(UpAxis::kY, "assumed")};
}

/// Listens for the one thing that a reader reports only in its log: faces that it dropped because
/// their vertices do not exist. Sets up the library's global logger, so use it only in a process of
/// its own.
class DroppedFacesLog final : public Assimp::LogStream {
 public:
  DroppedFacesLog() {
    Assimp::DefaultLogger::create(nullptr, Assimp::Logger::NORMAL, 0);
    Assimp::DefaultLogger::get()->attachStream(this, Assimp::Logger::Warn | Assimp::Logger::Err);
  }
  ~DroppedFacesLog() override {
    Assimp::DefaultLogger::get()->detachStream(this, Assimp::Logger::Warn | Assimp::Logger::Err);
    Assimp::DefaultLogger::kill();
  }
  DroppedFacesLog(const DroppedFacesLog&) = delete;
  DroppedFacesLog& operator=(const DroppedFacesLog&) = delete;
  DroppedFacesLog(DroppedFacesLog&&) = delete;
  DroppedFacesLog& operator=(DroppedFacesLog&&) = delete;

  void write(const char* message) override {
    seen_ = seen_ || std::string_view(message).find("out-of-range") != std::string_view::npos;
  }
  [[nodiscard]] bool seen() const { return seen_; }

 private:
  bool seen_ = false;
};

/// One reading of one file.
class SceneReader {
 public:
  SceneReader(const std::filesystem::path& path, const MeshImportOptions& options,
              const ReaderCallbacks& callbacks)
      : path_(path), options_(options), callbacks_(callbacks) {}

  Result<SourceAsset> read();

 private:
  Result<void> load();
  Result<Affine> worldFromRoot();
  [[nodiscard]] Result<void> checkAffine(const aiNode& node) const;
  Result<void> placeNodes(const Affine& world_from_root);
  Result<void> convertMeshes(const SceneLooks& looks);
  void nameFiles();
  [[nodiscard]] Result<SourceMesh> convertMesh(const aiMesh& mesh, unsigned index,
                                               const SceneLooks& looks);
  [[nodiscard]] tl::unexpected<Error> invalid(std::string message) const {
    return fail(ErrorCode::kInvalidInput, path_.string(), std::move(message));
  }

  const std::filesystem::path& path_;
  const MeshImportOptions& options_;
  const ReaderCallbacks& callbacks_;
  std::unique_ptr<aiScene> scene_;
  Format format_{};
  SourceAsset asset_;
  AskedFiles asked_;
  /// Limit for cutting polygons: about a second's worth, and far beyond what polygons of models
  /// take.
  static constexpr std::uint64_t kMostComparisons = 200'000'000;
  std::uint64_t comparisons_left_ = kMostComparisons;
};

std::string text(const aiString& string) { return {string.C_Str()}; }

/// What the reader gets in place of the file, if it would misinterpret the file itself.
Result<std::optional<ReadableGltf>> readableAs(const std::filesystem::path& path, Reach reach) {
  const std::string extension = lowerCase(path.extension().string());
  if (extension != ".glb" && extension != ".gltf") return std::nullopt;
  ASSIGN_OR_RETURN(const auto file, MappedFile::open(path));
  return readableGltf(path, file.bytes(), reach);
}

Result<void> SceneReader::load() {
  DroppedFacesLog dropped_faces;
  Assimp::Importer importer;
  const Reach reach = options_.allow_outside ? Reach::kAnywhere : Reach::kNear;
  ASSIGN_OR_RETURN(auto readable, readableAs(path_, reach));
  // The importer takes ownership.
  importer.SetIOHandler(new RecordingFiles(asked_, path_, reach, std::move(readable)));
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_ANIMATIONS, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_CAMERAS, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_LIGHTS, false);
  // Names embedded images "*N", as other formats do, instead of after files that do not exist.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_EMBEDDED_TEXTURES_LEGACY_NAMING, true);
  // No post-processing: the library's own triangulation covers the notches of concave polygons.
  const bool read = importer.ReadFile(path_.string(), 0) != nullptr;
  callbacks_.on_stage(ReadStage::kConversion);
  if (!read) {
    const std::string reason = importer.GetErrorString();
    if (reason.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
    if (!asked_.outside.empty()) {
      return invalid(
          fmt::format("it names '{}', which lies outside its folder; put the file there, "
                      "or give `allow-outside`",
                      nameRelativeTo(path_, asked_.outside.front())));
    }
    return invalid(
        fmt::format("its content cannot be read as {}: {}; export it again, or convert "
                    "it to GLB",
                    path_.extension().string(), reason.empty() ? "no reason given" : reason));
  }
  // The checks before this one took the format from the name, too.
  const aiImporterDesc* reader = readerOf(importer);
  if (reader != nullptr && !isForName(*reader, path_)) {
    return invalid(
        fmt::format("its content is not what its name says, but of the kind '{}'; name "
                    "it as such, or export it again",
                    reader->mName));
  }
  if (dropped_faces.seen()) {
    return invalid("it has faces that use vertices out of range; export it again");
  }
  format_ = formatOf(importer);
  asset_.format = format_.name;
  scene_.reset(importer.GetOrphanedScene());
  // From some broken files a reader makes a scene without any node.
  if (scene_->mRootNode == nullptr) {
    return invalid("it has no scene, so nothing in it has a place; export it again");
  }
  return {};
}

Affine toAffine(const aiMatrix4x4& m) {
  Affine affine{};
  for (unsigned i = 0; i < affine.size(); ++i) affine[i] = static_cast<double>(m[i / 4][i % 4]);
  return affine;
}

template <class T>
std::optional<T> metadata(const aiScene& scene, const char* key) {
  T value{};
  if (scene.mMetaData == nullptr || !scene.mMetaData->Get(key, value)) return std::nullopt;
  return value;
}

/// Reads what FBX states, but its reader does not apply: number and sign of the up axis, and
/// centimeters per unit.
AxisConvention fbxConvention(const aiScene& scene, AxisConvention convention) {
  const int axis = metadata<std::int32_t>(scene, "UpAxis").value_or(1);
  const int sign = metadata<std::int32_t>(scene, "UpAxisSign").value_or(1);
  if (axis >= 0 && axis <= 2) {
    convention.up.value = static_cast<UpAxis>(axis + (sign < 0 ? 3 : 0));
  }
  const auto centimeters = metadata<float>(scene, "UnitScaleFactor");
  convention.meters = centimeters ? Stated<double>{shortestDecimal(*centimeters) / 100, kByFile}
                                  : Stated<double>{0.01, "FBX convention"};
  return convention;
}

Result<Affine> SceneReader::worldFromRoot() {
  Affine file_from_root = toAffine(scene_->mRootNode->mTransformation);
  AxisConvention convention = format_.convention;
  if (format_.reader == kColladaReader) {
    // The reader writes up axis and unit, and nothing else, into the root's transform. Takes them
    // out again, so that an override replaces them instead of adding to them.
    const auto stated = conventionOf(file_from_root, kByFile);
    if (!stated && !(options_.up && options_.scale)) {
      return invalid(
          "the meters of its <unit> are not a positive number; correct them, or give "
          "`scale` and `up`");
    }
    convention = stated.value_or(convention);
    file_from_root = kIdentityAffine;
  } else if (format_.reader == kFbxReader) {
    convention = fbxConvention(*scene_, convention);
  }
  convention = withOverrides(convention, options_);
  if (!std::isfinite(convention.meters.value) || convention.meters.value <= 0) {
    return invalid("its unit is not a positive number of meters; give `scale`");
  }
  asset_.convention = describe(convention);
  asset_.meters_per_unit = convention.meters.value;
  asset_.unit_is_stated = isUnitStated(convention);
  return compose(compose(options_.transform.value_or(kIdentityAffine), worldFromFile(convention)),
                 file_from_root);
}

bool hasAffineBottomRow(const aiMatrix4x4& m) {
  constexpr float kFloatRounding = 1e-6F;
  const std::array<float, 4> deviation{m.d1, m.d2, m.d3, m.d4 - 1};
  return std::all_of(deviation.begin(), deviation.end(),
                     [](float d) { return std::abs(d) <= kFloatRounding; });
}

Result<void> SceneReader::checkAffine(const aiNode& node) const {
  if (hasAffineBottomRow(node.mTransformation)) return {};
  return invalid(
      fmt::format("node '{}' has a projective transform; only affine ones (bottom "
                  "row 0 0 0 1) can be placed",
                  node.mName.C_Str()));
}

Result<void> SceneReader::placeNodes(const Affine& world_from_root) {
  struct Placed {
    const aiNode* node;
    Affine world_from_node;
  };
  // Uses a stack of its own: hostile files nest nodes deeper than the call stack.
  std::vector<Placed> open{{scene_->mRootNode, world_from_root}};
  // The transform of COLLADA's root has been used up; one that is not finite is reported later.
  const aiMatrix4x4& root = scene_->mRootNode->mTransformation;
  const bool finite = std::isfinite(root.d1 + root.d2 + root.d3 + root.d4);
  if (finite && format_.reader != kColladaReader) {
    if (auto checked = checkAffine(*scene_->mRootNode); !checked) return checked;
  }
  while (!open.empty()) {
    const Placed at = open.back();
    open.pop_back();
    for (unsigned i = 0; i < at.node->mNumMeshes; ++i) {
      asset_.instances.push_back({.name = text(at.node->mName),
                                  .mesh = at.node->mMeshes[i],
                                  .world_from_mesh = at.world_from_node});
    }
    for (unsigned i = at.node->mNumChildren; i-- > 0;) {
      const aiNode* child = at.node->mChildren[i];
      if (auto checked = checkAffine(*child); !checked) return checked;
      open.push_back({child, compose(at.world_from_node, toAffine(child->mTransformation))});
    }
  }
  return {};
}

/// The positions of a mesh, with glTF's morph targets applied by the weights of the mesh. Weights
/// of other readers are not those of the file's shape: they may be 1 for an FBX whatever it states.
std::vector<Vec3> positionsOf(const aiMesh& mesh, std::string_view reader) {
  std::vector<Vec3> positions;
  const std::size_t vertices = mesh.mVertices == nullptr ? 0 : mesh.mNumVertices;
  const auto own = std::span(mesh.mVertices, vertices);
  positions.reserve(vertices);
  for (const aiVector3D& v : own) positions.push_back({v.x, v.y, v.z});
  if (reader != kGltf2Reader) return positions;
  for (const aiAnimMesh* target : std::span(mesh.mAnimMeshes, mesh.mNumAnimMeshes)) {
    const float weight = target->mWeight;
    if (weight == 0 || target->mVertices == nullptr || target->mNumVertices != vertices) continue;
    for (std::size_t n = 0; n < vertices; ++n) {
      const aiVector3D offset = target->mVertices[n] - own[n];
      positions[n].x += weight * offset.x;
      positions[n].y += weight * offset.y;
      positions[n].z += weight * offset.z;
    }
  }
  return positions;
}

/// Number of triangle corners whose texture coordinates are not finite.
std::size_t cornersWithoutUv(const SourceMesh& mesh) {
  if (mesh.uvs.empty()) return 0;
  std::size_t corners = 0;
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) {
      // Vertices out of range are refused later.
      if (vertex >= mesh.uvs.size()) continue;
      const auto& [u, v] = mesh.uvs[vertex];
      if (!std::isfinite(u) || !std::isfinite(v)) ++corners;
    }
  }
  return corners;
}

/// Drops the vertices of a shared pool that this mesh does not use. Keeps all if the mesh has
/// corners out of range; it is refused later.
void dropUnusedVertices(SourceMesh& mesh) {
  const std::size_t count = mesh.positions.size();
  for (const Triangle& triangle : mesh.triangles) {
    if (*std::max_element(triangle.begin(), triangle.end()) >= count) return;
  }
  const std::vector<std::uint32_t> places = placesOfUsed(count, mesh.triangles);
  keepUsed(places, mesh.positions);
  keepUsed(places, mesh.uvs);
  keepUsed(places, mesh.colors);
  moveCorners(places, mesh.triangles);
}

Result<SourceMesh> SceneReader::convertMesh(const aiMesh& mesh, unsigned index,
                                            const SceneLooks& looks) {
  SourceMesh converted;
  converted.name = text(mesh.mName);
  converted.material = mesh.mMaterialIndex;
  if (converted.name.empty()) converted.name = fmt::format("mesh {}", index);
  converted.positions = positionsOf(mesh, format_.reader);
  converted.uvs = looks.uvsOf(mesh);
  converted.colors = looks.colorsOf(mesh);
  const auto faces = std::span(mesh.mFaces, mesh.mFaces == nullptr ? 0 : mesh.mNumFaces);
  converted.triangles.reserve(faces.size());
  std::size_t others = 0;
  for (const aiFace& face : faces) {
    if (face.mNumIndices < 3) ++others;
    if (!triangulatePolygon({face.mIndices, face.mNumIndices}, converted.positions,
                            comparisons_left_, converted.triangles)) {
      return invalid(
          fmt::format("mesh '{}' has a polygon of {} corners, and the file's polygons take more "
                      "than {} comparisons to be cut into triangles; export triangles",
                      converted.name, face.mNumIndices, kMostComparisons));
    }
  }
  if (others != 0) {
    asset_.warnings.push_back(fmt::format("mesh '{}' ({}) has {} points or lines: ignored",
                                          converted.name, index, others));
  }
  if (const std::size_t corners = cornersWithoutUv(converted); corners != 0) {
    asset_.warnings.push_back(
        fmt::format("mesh '{}' ({}) has {} corners whose texture coordinates are not finite: its "
                    "texture is drawn wrong there; export it again",
                    converted.name, index, corners));
  }
  dropUnusedVertices(converted);
  return converted;
}

Result<void> SceneReader::convertMeshes(const SceneLooks& looks) {
  for (unsigned i = 0; i < scene_->mNumMeshes; ++i) {
    ASSIGN_OR_RETURN(auto mesh, convertMesh(*scene_->mMeshes[i], i, looks));
    callbacks_.on_mesh(mesh);
    delete std::exchange(scene_->mMeshes[i], nullptr);  // peak memory: one mesh twice, not all
  }
  return {};
}

void SceneReader::nameFiles() {
  for (const std::string& file : asked_.opened) {
    asset_.read.files.push_back({.name = nameRelativeTo(path_, file)});
  }
  for (const std::filesystem::path& file : asked_.search.absent()) {
    asset_.read.absent.push_back(nameRelativeTo(path_, file));
  }
  // If the MTL that it names is missing, the OBJ reader looks for one named like the OBJ: warns
  // only once.
  std::filesystem::path namesake = path_;
  namesake.replace_extension(".mtl");
  std::vector<std::string>& missing = asked_.missing;
  std::erase_if(missing, [&](const std::string& file) {
    const bool is_asked_first = asked_.outside.empty() && file == missing.front();
    return file == namesake.string() && !is_asked_first;
  });
  for (const std::string& file : asked_.outside) {
    asset_.warnings.push_back(fmt::format(
        "'{}' lies outside the folder of the mesh and is not read; put it there, or give "
        "`allow-outside`",
        nameRelativeTo(path_, file)));
  }
  // Other readers ask for optional files, or report missing ones themselves.
  if (format_.reader != kObjReader) return;
  for (const std::string& file : missing) {
    asset_.missing_materials.push_back(nameRelativeTo(path_, file));
  }
}

Result<SourceAsset> SceneReader::read() {
  RETURN_IF_ERROR(load());
  warnOfWraps(*scene_, asset_.warnings);
  ASSIGN_OR_RETURN(auto world_from_root, worldFromRoot());
  if (auto placed = placeNodes(world_from_root); !placed) {
    return tl::unexpected(std::move(placed.error()));
  }
  const SceneLooks looks(*scene_, format_.reader);
  if (auto converted = convertMeshes(looks); !converted) {
    return tl::unexpected(std::move(converted.error()));
  }
  asset_.materials = looks.materials(asset_.warnings);
  asset_.textures = looks.textures(asset_.warnings);
  nameFiles();
  asset_.name = path_.stem().string();
  return std::move(asset_);
}

}  // namespace

bool hasReader(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  return extension.size() > 1 && Assimp::Importer().IsExtensionSupported(extension);
}

std::string readableExtensions() {
  aiString list;
  Assimp::Importer().GetExtensionList(list);
  std::string extensions = text(list);
  std::erase(extensions, '*');
  std::replace(extensions.begin(), extensions.end(), ';', ' ');
  return extensions;
}

Result<SourceAsset> readWithAssimp(const std::filesystem::path& path,
                                   const MeshImportOptions& options,
                                   const ReaderCallbacks& callbacks) {
  ASSIGN_OR_RETURN(const auto warnings, checkContent(path));
  auto asset = SceneReader(path, options, callbacks).read();
  if (asset) asset->warnings.insert(asset->warnings.end(), warnings.begin(), warnings.end());
  return asset;
}

}  // namespace galactic::bake
