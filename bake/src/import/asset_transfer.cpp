#include "import/asset_transfer.h"

#include <cstring>
#include <string>
#include <type_traits>
#include <utility>

namespace galactic::bake {
namespace {

enum class Record : std::uint32_t { kMesh = 1, kRest = 2, kError = 3 };

template <class T>
concept Plain = std::is_trivially_copyable_v<T>;

template <class T, class Base>
concept Is = std::is_same_v<std::remove_const_t<T>, Base>;

// One list of fields per type serves both directions: the archive is a writer or a reader.
template <class Archive>
void transferFields(Archive& archive, Is<SourceMesh> auto& mesh) {
  archive(mesh.name, mesh.positions, mesh.uvs, mesh.colors, mesh.triangles, mesh.material);
}

template <class Archive>
void transferFields(Archive& archive, Is<SourceInstance> auto& instance) {
  archive(instance.name, instance.mesh, instance.world_from_mesh);
}

template <class Archive>
void transferFields(Archive& archive, Is<SourceMaterial> auto& material) {
  archive(material.name, material.base_color, material.base_color_texture, material.two_sided);
}

template <class Archive>
void transferFields(Archive& archive, Is<EmbeddedTexture> auto& texture) {
  archive(texture.format, texture.bytes);
}

template <class Archive>
void transferFields(Archive& archive, Is<SourceFile> auto& file) {
  archive(file.name, file.bytes, file.hash_low, file.hash_high);
}

template <class Archive>
void transferFields(Archive& archive, Is<Error> auto& error) {
  archive(error.code, error.where, error.message);
}

/// Everything of an asset but its meshes.
template <class Archive>
void transferRest(Archive& archive, auto& asset) {
  archive(asset.name, asset.format, asset.convention, asset.instances, asset.materials,
          asset.textures, asset.files, asset.warnings);
}

class Writer {
 public:
  explicit Writer(const TransferSink& sink) : sink_(sink) {}

  template <class... Fields>
  void operator()(const Fields&... fields) {
    (put(fields), ...);
  }

 private:
  template <class T>
  void put(const T& value) {
    if constexpr (Plain<T>) {
      sink_(std::as_bytes(std::span(&value, 1)));
    } else if constexpr (requires { value.data(); }) {
      putList(value);
    } else {
      transferFields(*this, value);
    }
  }

  void putList(const auto& list) {
    using Element = std::remove_cvref_t<decltype(list[0])>;
    put(std::uint64_t{list.size()});
    if constexpr (Plain<Element>) {
      sink_(std::as_bytes(std::span(list.data(), list.size())));
    } else {
      for (const Element& element : list) put(element);
    }
  }

  const TransferSink& sink_;
};

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : left_(bytes) {}

  [[nodiscard]] bool good() const { return good_; }
  [[nodiscard]] bool atEnd() const { return left_.empty(); }

  template <class... Fields>
  void operator()(Fields&... fields) {
    (get(fields), ...);
  }

 private:
  template <class T>
  void get(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      std::uint8_t byte = 0;
      get(byte);
      value = byte != 0;
    } else if constexpr (Plain<T>) {
      take(&value, sizeof(T));
    } else if constexpr (requires { value.data(); }) {
      getList(value);
    } else {
      transferFields(*this, value);
    }
  }

  void getList(auto& list) {
    using Element = std::remove_cvref_t<decltype(list[0])>;
    std::uint64_t size = 0;
    get(size);
    if constexpr (Plain<Element>) {
      if (!good_ || size > left_.size() / sizeof(Element)) return stop();
      list.resize(static_cast<std::size_t>(size));
      take(list.data(), list.size() * sizeof(Element));
    } else {
      // An element takes at least one byte, so a false size ends with the input.
      for (std::uint64_t i = 0; i < size && good_; ++i) get(list.emplace_back());
    }
  }

  void take(void* to, std::size_t bytes) {
    if (!good_ || bytes > left_.size()) return stop();
    if (bytes == 0) return;
    std::memcpy(to, left_.data(), bytes);
    left_ = left_.subspan(bytes);
  }

  void stop() {
    good_ = false;
    left_ = {};
  }

  std::span<const std::byte> left_;
  bool good_ = true;
};

}  // namespace

void AssetSender::mesh(const SourceMesh& mesh) const {
  Writer writer(sink_);
  writer(Record::kMesh, mesh);
}

void AssetSender::finish(const SourceAsset& asset) const {
  Writer writer(sink_);
  writer(Record::kRest);
  transferRest(writer, asset);
}

void AssetSender::fail(const Error& error) const {
  Writer writer(sink_);
  writer(Record::kError, error);
}

Result<SourceAsset> receiveAsset(std::span<const std::byte> bytes) {
  Reader reader(bytes);
  SourceAsset asset;
  while (reader.good()) {
    Record record{};
    reader(record);
    if (!reader.good()) break;
    if (record == Record::kMesh) {
      reader(asset.meshes.emplace_back());
    } else if (record == Record::kRest) {
      transferRest(reader, asset);
      if (!reader.good() || !reader.atEnd()) break;
      return asset;
    } else if (record == Record::kError) {
      Error error;
      reader(error);
      if (!reader.good() || !reader.atEnd()) break;
      return tl::unexpected(std::move(error));
    } else {
      break;
    }
  }
  return fail(ErrorCode::kInternal, "mesh import",
              "the reading process delivered a broken asset; please report this with the file");
}

}  // namespace galactic::bake
