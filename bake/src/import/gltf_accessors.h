#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "galactic/error.h"
#include "import/source_files.h"
#include "support/files/mapped_file.h"

namespace galactic::bake {

/// Reads the numbers of a glTF document's accessors, and adds new accessors to the document.
class GltfAccessors {
 public:
  /// `document` is the JSON of the glTF 2.0 file `path`, whose bytes are `file` and have passed
  /// checkGltfRanges; all must outlive this. Looks for other buffers in the file's folder, as far
  /// as `reach` allows.
  GltfAccessors(nlohmann::json& document, const std::filesystem::path& path,
                std::span<const std::byte> file, Reach reach);

  [[nodiscard]] bool isFloat(std::uint64_t accessor) const;

  /// The numbers of an accessor, `components` (2 or 3) for each element, converted from any
  /// component type; normalized integers become 0 to 1, or -1 to 1. Without a buffer view all
  /// numbers are 0 except those of sparse elements. None if the accessor has another type or one of
  /// its buffers does not exist. Fails with kInvalidInput if a buffer is too short for the
  /// accessor, or if a sparse index is out of the accessor's range.
  [[nodiscard]] Result<std::optional<std::vector<double>>> read(std::uint64_t accessor,
                                                                std::uint64_t components);

  /// Adds an accessor with these numbers, as floats, to the document; returns its index.
  [[nodiscard]] std::uint64_t append(std::span<const double> numbers, std::uint64_t components);

  /// If any numbers were appended, adds their buffer to the document under the name `uri`. Returns
  /// the buffer's bytes. Must be the last call.
  [[nodiscard]] std::string finish(std::string_view uri);

 private:
  /// A buffer's bytes: from a file, or from a data URI.
  struct Buffer {
    std::optional<MappedFile> mapped;
    std::string decoded;
  };
  /// The elements of an accessor within their buffer.
  struct Elements {
    std::span<const std::byte> bytes;
    std::size_t stride = 0;

    [[nodiscard]] const std::byte* at(std::uint64_t n) const { return bytes.data() + n * stride; }
  };

  [[nodiscard]] std::span<const std::byte> bufferAt(std::uint64_t number);
  [[nodiscard]] std::span<const std::byte> ownBuffer() const;
  [[nodiscard]] Buffer find(const std::string& uri) const;
  /// `count` elements of `bytes` bytes each in the buffer view that `owner` names; none if its
  /// buffer does not exist. Fails with kInvalidInput if the buffer is too short for them.
  [[nodiscard]] Result<std::optional<Elements>> elementsOf(const nlohmann::json& owner,
                                                           std::uint64_t count,
                                                           std::uint64_t bytes);

  /// Writes the sparse elements of the accessor into `numbers`; false if one of their buffers does
  /// not exist.
  [[nodiscard]] Result<bool> replaceSparse(std::uint64_t accessor, std::uint64_t components,
                                           std::vector<double>& numbers);

  nlohmann::json& document_;
  const std::filesystem::path& path_;
  std::span<const std::byte> file_;
  Reach reach_;
  /// Buffers by their index; each is looked for only once.
  std::map<std::uint64_t, Buffer> buffers_;
  /// The bytes of the appended numbers.
  std::string floats_;
};

}  // namespace galactic::bake
