#pragma once
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "galactic/error.h"
#include "galactic/pack_header.h"

namespace galactic {

namespace schema {
struct Pack;
}

/// How much of a pack is checked when it is opened.
enum class Trust {
  kVerify,   ///< Hash, structure and every value, at memory speed: for anything from outside.
  kTrusted,  ///< Header only: for packs that this machine has verified before.
};

/// An open pack: the checked bytes, and the FlatBuffer in them. Movable; immutable, so safe to
/// share between threads. What it returns is valid as long as it lives. A PackFile that was moved
/// from holds no bytes, and throws ErrorException with kInvalidInput if you ask for its content.
class PackFile {
 public:
  /// Maps and checks `path`. Errors name the file, the field and what is wrong: kIo (cannot be
  /// read), kInvalidInput (damaged, or not a pack), kUnsupported (another format version).
  [[nodiscard]] static Result<PackFile> open(const std::filesystem::path& path,
                                             Trust trust = Trust::kVerify);

  /// The same for a pack in memory, which must be 32-byte aligned and outlive the result. `where`
  /// names it in errors.
  [[nodiscard]] static Result<PackFile> view(std::span<const std::byte> file, std::string where,
                                             Trust trust = Trust::kVerify);

  ~PackFile();
  PackFile(PackFile&&) noexcept;
  PackFile& operator=(PackFile&&) noexcept;

  [[nodiscard]] const PackHeader& header() const { return header_; }
  [[nodiscard]] PackKind kind() const { return header_.kind; }
  [[nodiscard]] const schema::Pack& root() const;
  /// The whole file's bytes.
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }
  /// The path or name given at opening.
  [[nodiscard]] const std::string& where() const { return where_; }

 private:
  PackFile() = default;

  class Storage;
  std::unique_ptr<Storage> storage_;
  std::span<const std::byte> bytes_;
  PackHeader header_;
  const schema::Pack* root_ = nullptr;
  std::string where_;
};

}  // namespace galactic
