#include "dataset/mesh_library.h"

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "galactic/bake/robot_import.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

template <class T>
std::uint64_t bytesIn(const std::vector<T>& values) {
  return std::uint64_t{sizeof(T)} * values.size();
}

std::uint64_t bytesOf(const SourceAsset& asset) {
  std::uint64_t bytes = sizeof(SourceAsset) + bytesIn(asset.instances) + bytesIn(asset.materials);
  for (const SourceMesh& mesh : asset.meshes) {
    bytes += sizeof(SourceMesh) + bytesIn(mesh.positions) + bytesIn(mesh.uvs) +
             bytesIn(mesh.colors) + bytesIn(mesh.triangles);
  }
  for (const EmbeddedTexture& texture : asset.textures) bytes += bytesIn(texture.bytes);
  return bytes;
}

std::uint64_t bytesOf(const SourceRobot& robot) {
  std::uint64_t bytes = sizeof(SourceRobot) + bytesIn(robot.links);
  for (const SourceAsset& mesh : robot.meshes) bytes += bytesOf(mesh);
  return bytes;
}

/// The same for all spellings of a path.
std::string keyOf(const fs::path& file) {
  std::error_code ignored;
  return fs::absolute(file, ignored).lexically_normal().string();
}

/// What was read of files, by path.
template <class T>
struct Shelf {
  struct Entry {
    /// None while it is being read.
    std::optional<Result<std::shared_ptr<const T>>> content;
    std::uint64_t bytes = 0;
    /// Of the last load; no two are the same.
    std::uint64_t used = 0;
  };
  std::map<std::string, Entry> entries;
};

template <class T>
typename Shelf<T>::Entry sharedEntry(Result<T> content) {
  typename Shelf<T>::Entry entry;
  if (content) {
    entry.bytes = bytesOf(*content);
    entry.content = std::make_shared<const T>(std::move(*content));
  } else {
    entry.content = tl::unexpected<Error>(content.error());
  }
  return entry;
}

/// Whether only the library holds it. Called under the library's mutex: nobody can take another
/// copy meanwhile.
template <class Entry>
bool isIdle(const Entry& entry) {
  return entry.content && entry.content->has_value() && (*entry.content)->use_count() == 1;
}

template <class T>
std::uint64_t idleBytes(const Shelf<T>& shelf) {
  std::uint64_t bytes = 0;
  for (const auto& [key, entry] : shelf.entries) {
    if (isIdle(entry)) bytes += entry.bytes;
  }
  return bytes;
}

/// What is idle and was not loaded for longest; the end where nothing is.
template <class T>
auto oldestIdle(Shelf<T>& shelf) {
  auto oldest = shelf.entries.end();
  for (auto entry = shelf.entries.begin(); entry != shelf.entries.end(); ++entry) {
    if (!isIdle(entry->second)) continue;
    if (oldest == shelf.entries.end() || entry->second.used < oldest->second.used) oldest = entry;
  }
  return oldest;
}

}  // namespace

struct MeshLibrary::State {
  MeshImportOptions options;
  std::uint64_t memory_limit = 0;
  std::mutex mutex;
  std::condition_variable was_read;
  std::uint64_t loads = 0;
  Shelf<SourceAsset> meshes;
  Shelf<SourceRobot> furniture;

  template <class T>
  Result<std::shared_ptr<const T>> load(Shelf<T>& shelf, const std::string& key,
                                        const std::function<Result<T>()>& read);
  /// Gives up what is idle, that which was not loaded for longest first.
  void makeRoom();
};

template <class T>
Result<std::shared_ptr<const T>> MeshLibrary::State::load(Shelf<T>& shelf, const std::string& key,
                                                          const std::function<Result<T>()>& read) {
  std::unique_lock lock(mutex);
  // While it is read by another, this waits; it may be given up before this wakes.
  while (!shelf.entries.try_emplace(key).second) {
    auto& entry = shelf.entries.at(key);
    if (entry.content) {
      entry.used = ++loads;
      return *entry.content;
    }
    was_read.wait(lock);
  }
  lock.unlock();
  typename Shelf<T>::Entry fresh;
  try {
    fresh = sharedEntry(read());
  } catch (...) {
    // Memory ran out: nobody may wait for what does not come.
    lock.lock();
    shelf.entries.erase(key);
    was_read.notify_all();
    throw;
  }
  // Held here, it is not idle when room is made.
  Result<std::shared_ptr<const T>> content = *fresh.content;
  lock.lock();
  fresh.used = ++loads;
  shelf.entries.at(key) = std::move(fresh);
  makeRoom();
  was_read.notify_all();
  return content;
}

void MeshLibrary::State::makeRoom() {
  while (idleBytes(meshes) + idleBytes(furniture) > memory_limit) {
    const auto mesh = oldestIdle(meshes);
    const auto piece = oldestIdle(furniture);
    const bool has_mesh = mesh != meshes.entries.end();
    const bool has_piece = piece != furniture.entries.end();
    if (has_piece && (!has_mesh || piece->second.used < mesh->second.used)) {
      furniture.entries.erase(piece);
    } else if (has_mesh) {
      meshes.entries.erase(mesh);
    } else {
      return;
    }
  }
}

MeshLibrary::MeshLibrary(MeshImportOptions options, std::uint64_t memory_limit)
    : state_(std::make_unique<State>()) {
  state_->options = options;
  state_->memory_limit = memory_limit;
}

MeshLibrary::~MeshLibrary() = default;

Result<std::shared_ptr<const SourceAsset>> MeshLibrary::load(const fs::path& file) {
  return state_->load<SourceAsset>(state_->meshes, keyOf(file),
                                   [&] { return importMesh(file, state_->options); });
}

Result<std::shared_ptr<const SourceRobot>> MeshLibrary::loadFurniture(const fs::path& urdf) {
  RobotImportOptions options;
  options.up = UpAxis::kY;
  options.allow_missing = true;
  options.allow_outside = state_->options.allow_outside;
  return state_->load<SourceRobot>(state_->furniture, keyOf(urdf),
                                   [&] { return importRobot(urdf, options); });
}

}  // namespace galactic::bake
