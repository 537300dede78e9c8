#include "galactic/bake/mesh_import.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include "common/lfs_pointer.h"
#include "import/affine.h"
#include "import/asset_transfer.h"
#include "import/assimp_reader.h"
#include "import/checks/asset_check.h"
#include "import/isolated_process.h"
#include "import/source_files.h"
#include "support/out_of_memory.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

Result<void> checkOptions(const MeshImportOptions& options) {
  if (options.scale && !(std::isfinite(*options.scale) && *options.scale > 0)) {
    return fail(
        ErrorCode::kInvalidInput, "scale",
        fmt::format("the scale {} is out of range; give a positive number of meters per unit",
                    *options.scale));
  }
  if (options.transform && !(isFinite(*options.transform) && isInvertible(*options.transform))) {
    return fail(ErrorCode::kInvalidInput, "transform",
                "it is not finite or flattens space; give an invertible affine transform");
  }
  return {};
}

std::string unknownExtension(const fs::path& path) {
  if (path.extension() == ".xacro") {
    return "it is a xacro file; expand it with the xacro tool and give the resulting .urdf";
  }
  return fmt::format("no reader knows the extension '{}'; expected one of {}",
                     path.extension().string(), readableExtensions());
}

Result<void> checkMainFile(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) {
    return fail(ErrorCode::kIo, path.string(),
                hasReader(path) || !path.has_extension()
                    ? "there is no such file; check the path"
                    : "there is no such file, and " + unknownExtension(path));
  }
  if (!fs::exists(status)) {
    return fail(ErrorCode::kIo, path.string(),
                fmt::format("cannot look at the file: {}", error.message()));
  }
  if (fs::is_directory(status)) {
    return fail(ErrorCode::kIo, path.string(),
                "it is a folder; give the path of a mesh file inside it");
  }
  if (!fs::is_regular_file(status)) {
    return fail(ErrorCode::kIo, path.string(), "it is not a regular file; give a mesh file");
  }
  if (::access(path.c_str(), R_OK) != 0) {
    return fail(ErrorCode::kIo, path.string(),
                fmt::format("cannot read the file: {}", std::generic_category().message(errno)));
  }
  if (!hasReader(path)) {
    return fail(ErrorCode::kUnsupported, path.string(), unknownExtension(path));
  }
  if (fs::file_size(path, error) == 0) {
    return fail(ErrorCode::kInvalidInput, path.string(),
                "the file is empty; export or download it again");
  }
  if (isLfsPointer(path)) {
    return fail(ErrorCode::kInvalidInput, path.string(),
                fmt::format("is {}; expected a mesh", kLfsPointer));
  }
  return {};
}

Error readingFailure(const fs::path& path, const ProcessFailure& failure,
                     const MeshImportOptions& options) {
  const std::string reader = "the reader for " + path.extension().string() + " files";
  Error error{.code = ErrorCode::kInvalidInput, .where = path.string(), .message = {}};
  switch (failure.end) {
    case ProcessEnd::kNotStarted:
      error.code = ErrorCode::kInternal;
      error.message = fmt::format("cannot start {}: {}", reader,
                                  std::generic_category().message(failure.number));
      return error;
    case ProcessEnd::kTimeLimit:
      error.message = fmt::format(
          "{} did not finish within {} s; the file is broken or too large: "
          "export it again or split it",
          reader, options.time_limit.count());
      return error;
    case ProcessEnd::kMemoryLimit:
      if (ownMemoryLimit() < options.memory_limit) {
        error = outOfMemory();
        error.where = path.string();
        return error;
      }
      error.message = fmt::format(
          "{} needs more than {:.3g} GiB of memory; the file is broken or "
          "too large: export it again or split it",
          reader, std::ldexp(static_cast<double>(options.memory_limit), -30));
      return error;
    case ProcessEnd::kCrashed:
    case ProcessEnd::kFailed:
      break;
  }
  const std::string how = failure.end == ProcessEnd::kCrashed
                              ? fmt::format("crashed (signal {})", failure.number)
                              : fmt::format("stopped (exit code {})", failure.number);
  if (failure.stage == static_cast<std::uint32_t>(ReadStage::kConversion)) {
    error.code = ErrorCode::kInternal;
    error.message = fmt::format(
        "the conversion of what {} read {}; please report this with the "
        "file",
        reader, how);
  } else {
    error.message = fmt::format("{} {}: the file is broken; export it again, or convert it to GLB",
                                reader, how);
  }
  return error;
}

void readInChild(const fs::path& path, const MeshImportOptions& options, ProcessChannel& channel) {
  const AssetSender sender([&](std::span<const std::byte> bytes) { channel.write(bytes); });
  const ReaderCallbacks callbacks{
      .on_mesh = [&](const SourceMesh& mesh) { sender.mesh(mesh); },
      .on_stage = [&](ReadStage stage) { channel.enterStage(static_cast<std::uint32_t>(stage)); },
  };
  const auto rest = readWithAssimp(path, options, callbacks);
  if (rest) {
    sender.finish(*rest);
  } else {
    sender.fail(rest.error());
  }
}

Result<SourceAsset> readIsolated(const fs::path& path, const MeshImportOptions& options) {
  const ProcessLimits limits{.wall_clock = options.time_limit, .memory = options.memory_limit};
  const auto output =
      runIsolated([&](ProcessChannel& channel) { readInChild(path, options, channel); }, limits);
  if (!output) return tl::unexpected(readingFailure(path, output.error(), options));
  return receiveAsset(output->bytes());
}

}  // namespace

Result<SourceAsset> importMesh(const fs::path& path, const MeshImportOptions& options) {
  RETURN_IF_ERROR(checkOptions(options));
  RETURN_IF_ERROR(checkMainFile(path));
  auto asset = readIsolated(path, options);
  if (!asset) return asset;
  RETURN_IF_ERROR(checkAsset(*asset, path.string()));
  findTextures(*asset, path, options.allow_outside ? Reach::kAnywhere : Reach::kNear);
  RETURN_IF_ERROR(hashFiles(asset->read.files, path));
  warnAboutSize(*asset, options.smallest_size);
  return asset;
}

}  // namespace galactic::bake
