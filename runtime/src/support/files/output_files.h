#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "galactic/error.h"

namespace galactic {

/// Whether there is anything of this name, or a folder, links followed; no where that is not to be
/// found out.
[[nodiscard]] bool isThere(const std::filesystem::path& path);
[[nodiscard]] bool isFolder(const std::filesystem::path& path);

/// Whether two names lead to one file: links are followed, "a" and "./a" are the same, also where
/// there is no file yet.
[[nodiscard]] bool isSameFile(const std::filesystem::path& a, const std::filesystem::path& b);

/// Fails with kInvalidInput when `output` is the file `input`, which writing would lose.
[[nodiscard]] Result<void> checkNotInput(const std::filesystem::path& output,
                                         const std::filesystem::path& input);

/// A file that a program may write, and the option that asks for it.
struct OutputFile {
  std::string_view option;
  std::filesystem::path file;
};

/// Fails with kInvalidInput when one of the outputs is an input, or the output of another option.
[[nodiscard]] Result<void> checkOutputs(std::span<const OutputFile> outputs,
                                        std::span<const std::filesystem::path> inputs);

/// The extension of a path in lower case, with its dot.
[[nodiscard]] std::string extensionOf(const std::filesystem::path& path);

/// What a file is, as its name has to say: ".png", "pictures are PNG files".
struct FileKind {
  std::string_view extension;
  std::string_view sentence;
  /// Taken, too; empty for none.
  std::string_view short_extension = {};
};

inline constexpr FileKind kPageFile{".html", "pages are HTML files", ".htm"};
inline constexpr FileKind kPictureFile{".png", "pictures are PNG files"};

/// Fails with kUnsupported when a file that will be of this kind has another extension, and as
/// checkNotDash.
[[nodiscard]] Result<void> checkExtension(const std::filesystem::path& output,
                                          const FileKind& kind);

/// Fails with kIo for "-", which in many programs stands for the standard output: here a file of
/// that name would surprise.
[[nodiscard]] Result<void> checkNotDash(const std::filesystem::path& output);

/// Makes the folder and those above it that are not there; nothing where it is empty. Fails with
/// kIo.
[[nodiscard]] Result<void> makeFolders(const std::filesystem::path& folder);

/// Fails with kIo when no file can be written under this name, and for "-"; leaves a file of the
/// name as it is, and nothing else: what killed programs began to write under it is removed
/// (removeStaleParts), as far as it is among the first 30,000 names of the folder. Programs that
/// write a file begin with this.
[[nodiscard]] Result<void> tryFile(const std::filesystem::path& path);

}  // namespace galactic
