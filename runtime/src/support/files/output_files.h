#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "galactic/error.h"

namespace galactic {

/// Whether anything of this name exists, or a folder; links are followed. False if that cannot be
/// determined.
[[nodiscard]] bool isThere(const std::filesystem::path& path);
[[nodiscard]] bool isFolder(const std::filesystem::path& path);

/// Whether two names lead to the same file: links are followed, and "a" and "./a" are the same,
/// even if the file does not exist yet.
[[nodiscard]] bool isSameFile(const std::filesystem::path& a, const std::filesystem::path& b);

/// Fails with kInvalidInput when `output` is the file `input`, which writing would destroy.
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

/// A kind of file and the extension that its name must have: ".png", "pictures are PNG files".
struct FileKind {
  std::string_view extension;
  std::string_view sentence;
  /// Also accepted; empty: none.
  std::string_view short_extension = {};
};

inline constexpr FileKind kPageFile{".html", "pages are HTML files", ".htm"};
inline constexpr FileKind kPictureFile{".png", "pictures are PNG files"};

/// Fails with kUnsupported when a file that will be of this kind has another extension, and where
/// checkNotDash() fails.
[[nodiscard]] Result<void> checkExtension(const std::filesystem::path& output,
                                          const FileKind& kind);

/// Fails with kIo for "-", which stands for standard output in many programs: a file of that name
/// would be a surprise.
[[nodiscard]] Result<void> checkNotDash(const std::filesystem::path& output);

/// Makes the folder and all missing folders above it; does nothing for an empty path. Fails with
/// kIo.
[[nodiscard]] Result<void> makeFolders(const std::filesystem::path& folder);

/// Fails with kIo when no file can be written under this name, and for "-". Leaves an existing file
/// as it is and creates none, but removes what killed programs began to write under this name
/// (removeStaleParts), as far as it is among the first 30,000 names of the folder. Programs that
/// write a file begin with this call.
[[nodiscard]] Result<void> tryFile(const std::filesystem::path& path);

}  // namespace galactic
