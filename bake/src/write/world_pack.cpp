#include "galactic/bake/world_pack.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <system_error>
#include <utility>

#include "galactic/bake/source_asset.h"
#include "galactic/pack.h"
#include "galactic/render_library.h"
#include "galactic/world.h"
#include "support/try.h"
#include "write/pack_payload.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

bool leadsUpwards(const fs::path& path) {
  return path.empty() || path.is_absolute() || *path.begin() == "..";
}

/// `path` relative to `folder`: as it is written or, if that leads out of the folder, with symbolic
/// links resolved.
fs::path relativeTo(const fs::path& path, const fs::path& folder) {
  std::error_code problem;
  const fs::path from = fs::absolute(folder / "", problem).lexically_normal();
  fs::path as_written = fs::absolute(path, problem).lexically_normal().lexically_relative(from);
  if (!leadsUpwards(as_written)) return as_written;
  const fs::path real = fs::canonical(path, problem);
  const fs::path real_folder = problem ? fs::path() : fs::canonical(folder, problem);
  return problem ? as_written : real.lexically_relative(real_folder);
}

/// The fault of a path in a world's list; empty if it is valid.
std::string_view faultOf(std::string_view path) {
  if (path.empty()) return "is empty";
  if (path.find('\0') != std::string_view::npos) return "holds a zero byte";
  if (path.front() == '/') return "is absolute";
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    const std::string_view part = path.substr(begin, end - begin);
    if (part == "..") return "leads upwards";
    if (part.empty() || part == ".") return "has an empty part";
    begin = end + 1;
  }
  return "";
}

Result<void> checkCounts(const std::vector<LinkedPack>& packs) {
  const auto count = [&packs](PackKind kind) {
    return std::count_if(packs.begin(), packs.end(),
                         [kind](const LinkedPack& pack) { return pack.kind == kind; });
  };
  if (count(PackKind::kRobot) > 1 || count(PackKind::kEpisodes) > 1) {
    return fail(ErrorCode::kInvalidInput, "",
                fmt::format("the packs hold {} robots and {} episode sets, a world has at most one "
                            "of each",
                            count(PackKind::kRobot), count(PackKind::kEpisodes)));
  }
  if (count(PackKind::kScene) == 0) {
    return fail(ErrorCode::kInvalidInput, "",
                "the packs hold no scene, a world has at least one; add its pack");
  }
  return {};
}

Result<void> checkList(const std::vector<LinkedPack>& packs) {
  for (std::size_t n = 0; n < packs.size(); ++n) {
    const LinkedPack& pack = packs[n];
    if (const std::string_view fault = faultOf(pack.path); !fault.empty()) {
      return fail(ErrorCode::kInvalidInput, pack.path,
                  fmt::format("{}, a world lists packs by paths below its own folder", fault));
    }
    if (pack.kind == PackKind::kWorld) {
      return fail(ErrorCode::kInvalidInput, pack.path,
                  "is a world; list the packs that it lists instead");
    }
    if (n > 0 && packs[n - 1].path == pack.path) {
      return fail(ErrorCode::kInvalidInput, pack.path, "is there twice; give each pack once");
    }
  }
  return checkCounts(packs);
}

/// Null if there are no options, so that the bytes of such a world do not depend on this field.
Offset<flatbuffers::Vector<Offset<schema::Option>>> taskVector(FlatBufferBuilder& builder,
                                                               std::span<const OptionText> task) {
  if (task.empty()) return 0;
  std::vector<Offset<schema::Option>> options;
  options.reserve(task.size());
  for (const OptionText& option : task) {
    const auto name = builder.CreateString(option.name);
    const auto value = builder.CreateString(option.value);
    options.push_back(schema::CreateOption(builder, name, value));
  }
  return builder.CreateVector(options);
}

Result<PackFile> openTexture(const PackFile& pack, const MissingTexture& texture) {
  const fs::path beside = texturePackBeside(pack, texture).lexically_normal();
  auto opened = PackFile::open(beside);
  if (opened || opened.error().code != ErrorCode::kIo) return opened;
  return fail(
      ErrorCode::kIo, pack.where(),
      fmt::format("shares the texture \"{}\", whose pack {} cannot be opened; put it there, "
                  "or give its path, too",
                  texture.name, beside.string()));
}

/// Adds the shared texture packs that the packs use but that are not among them.
Result<void> addTextures(std::vector<PackFile>& packs) {
  SharedTextures textures;
  for (const PackFile& pack : packs) {
    if (pack.kind() == PackKind::kTexture) RETURN_IF_ERROR(textures.add(pack));
  }
  const std::size_t given = packs.size();
  for (std::size_t n = 0; n < given; ++n) {
    const auto meshes = renderMeshesOf(packs[n], textures);
    // Packs of other kinds have no render meshes.
    if (!meshes || !*meshes) continue;
    for (const MissingTexture& missing : (*meshes)->missing_textures) {
      if (textures.find(missing.hash_low, missing.hash_high) != nullptr) continue;
      ASSIGN_OR_RETURN(auto texture, openTexture(packs[n], missing));
      RETURN_IF_ERROR(textures.add(texture));
      packs.push_back(std::move(texture));
    }
  }
  return {};
}

bool comesBefore(const LinkedPack& a, const LinkedPack& b) { return a.path < b.path; }

}  // namespace

Result<std::vector<LinkedPack>> linkPacks(std::span<const fs::path> paths,
                                          const fs::path& world_folder) {
  const fs::path folder = world_folder.empty() ? "." : world_folder;
  std::vector<LinkedPack> linked;
  std::vector<PackFile> opened;
  opened.reserve(paths.size());
  for (const fs::path& path : paths) {
    ASSIGN_OR_RETURN(auto pack, PackFile::open(path));
    opened.push_back(std::move(pack));
  }
  RETURN_IF_ERROR(addTextures(opened));
  linked.reserve(opened.size());
  for (const PackFile& pack : opened) {
    const fs::path relative = relativeTo(pack.where(), folder);
    if (leadsUpwards(relative)) {
      return fail(ErrorCode::kInvalidInput, pack.where(),
                  fmt::format("does not lie in {} or below it, where the world pack is to be; put "
                              "the world pack above all its packs",
                              folder.string()));
    }
    const SourceFile file = describeBytes(relative.generic_string(), pack.bytes());
    linked.push_back({file.name, pack.kind(), file.bytes, file.hash_low, file.hash_high});
  }
  std::sort(linked.begin(), linked.end(), comesBefore);
  RETURN_IF_ERROR(checkList(linked));
  RETURN_IF_ERROR(checkTogether(std::move(opened)));
  return linked;
}

Result<std::vector<std::byte>> encodeWorldPack(std::vector<LinkedPack> packs,
                                               const Provenance& provenance,
                                               std::span<const OptionText> task) {
  std::sort(packs.begin(), packs.end(), comesBefore);
  RETURN_IF_ERROR(checkList(packs));
  FlatBufferBuilder builder;
  const auto provenance_table = provenanceTable(builder, provenance);
  std::vector<Offset<schema::PackReference>> references;
  references.reserve(packs.size());
  for (const LinkedPack& pack : packs) {
    const schema::Hash128 hash(pack.hash_low, pack.hash_high);
    const auto path = builder.CreateString(pack.path);
    const auto kind = builder.CreateString(packKindName(pack.kind));
    references.push_back(schema::CreatePackReference(builder, path, kind, pack.bytes, &hash));
  }
  const auto reference_vector = builder.CreateVector(references);
  const auto task_vector = taskVector(builder, task);
  const auto root = schema::CreateWorld(builder, reference_vector, task_vector);
  return finishPack(builder, provenance_table, schema::Asset::World, root.Union());
}

Result<std::uint64_t> writeWorldPack(const fs::path& path, std::vector<LinkedPack> packs,
                                     const Provenance& provenance,
                                     std::span<const OptionText> task) {
  ASSIGN_OR_RETURN(const auto payload, encodeWorldPack(std::move(packs), provenance, task));
  return writePackFile(path, PackKind::kWorld, payload);
}

}  // namespace galactic::bake
