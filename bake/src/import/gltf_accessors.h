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

/// Reads the numbers of a glTF document's accessors, and adds accessors of its own to it.
class GltfAccessors {
 public:
  /// `document` is the JSON of the glTF 2.0 file `path`, whose bytes are `file` and have passed
  /// checkGltfRanges; all outlive this. Other buffers are looked for in the file's folder, as far
  /// as `reach` allows.
  GltfAccessors(nlohmann::json& document, const std::filesystem::path& path,
                std::span<const std::byte> file, Reach reach);

  [[nodiscard]] bool isFloat(std::uint64_t accessor) const;

  /// The numbers of an accessor, `components` (2 or 3) for each element, whatever their type;
  /// normalized integers as 0 to 1, or -1 to 1. They are 0 where there is no buffer view, but for
  /// those that are sparse. None where the accessor is of another type, or a buffer of it is not
  /// there. Fails with kInvalidInput where a buffer cannot be read as far as the accessor needs it,
  /// and where a sparse element is none of the accessor's.
  [[nodiscard]] Result<std::optional<std::vector<double>>> read(std::uint64_t accessor,
                                                                std::uint64_t components);

  /// Adds an accessor of these numbers, as floats, to the document; returns its number.
  [[nodiscard]] std::uint64_t append(std::span<const double> numbers, std::uint64_t components);

  /// Adds the buffer `uri` of what was appended to the document, if anything was, and returns its
  /// bytes. The last call.
  [[nodiscard]] std::string finish(std::string_view uri);

 private:
  /// A buffer's bytes: of a file, or of a data URI.
  struct Buffer {
    std::optional<MappedFile> mapped;
    std::string decoded;
  };
  /// Elements of an accessor in their buffer.
  struct Elements {
    std::span<const std::byte> bytes;
    std::size_t stride = 0;

    [[nodiscard]] const std::byte* at(std::uint64_t n) const { return bytes.data() + n * stride; }
  };

  [[nodiscard]] std::span<const std::byte> bufferAt(std::uint64_t number);
  [[nodiscard]] std::span<const std::byte> ownBuffer() const;
  [[nodiscard]] Buffer find(const std::string& uri) const;
  /// `count` elements of `bytes` each in the buffer view that `owner` names; none where its buffer
  /// is not there. Fails with kInvalidInput where the buffer does not have so many.
  [[nodiscard]] Result<std::optional<Elements>> elementsOf(const nlohmann::json& owner,
                                                           std::uint64_t count,
                                                           std::uint64_t bytes);

  /// Puts the sparse elements of the accessor into its numbers; false where a buffer lacks.
  [[nodiscard]] Result<bool> replaceSparse(std::uint64_t accessor, std::uint64_t components,
                                           std::vector<double>& numbers);

  nlohmann::json& document_;
  const std::filesystem::path& path_;
  std::span<const std::byte> file_;
  Reach reach_;
  /// Each looked for once.
  std::map<std::uint64_t, Buffer> buffers_;
  /// Of the accessors that were added.
  std::string floats_;
};

}  // namespace galactic::bake
