#include "galactic/pack_reference.h"

#include <fmt/format.h>

#include <string>
#include <system_error>
#include <utility>

#include "check/world_check.h"
#include "pack/schema_values.h"
#include "support/content_hash.h"
#include "support/try.h"

namespace galactic {
namespace {

namespace fs = std::filesystem;

Result<const schema::World*> contentOf(const PackFile& world) {
  if (world.kind() == PackKind::kWorld) {
    if (const schema::World* stored = world.root().asset_as_World()) return stored;
  }
  return fail(ErrorCode::kInvalidInput, world.where(),
              "is a pack of kind " + packKindName(world.kind()) +
                  ", expected a world (WRLD); give a world pack");
}

/// Checks that the open file is the one that was linked.
Result<void> checkLinked(const PackFile& pack, const PackReference& reference,
                         const std::string& where, Trust trust) {
  const auto other = [&](std::string what) {
    return fail(ErrorCode::kInvalidInput, where,
                fmt::format("{}: it is not the pack that was linked; link the world again",
                            std::move(what)),
                "world/other-pack");
  };
  if (pack.kind() != reference.kind) {
    return other(fmt::format("lists {}, which is of kind {}, expected {}", pack.where(),
                             packKindName(pack.kind()), packKindName(reference.kind)));
  }
  if (pack.bytes().size() != reference.bytes) {
    return other(fmt::format("lists {}, which has {} bytes, expected {}", pack.where(),
                             pack.bytes().size(), reference.bytes));
  }
  if (trust == Trust::kTrusted) return {};
  const detail::ContentHash wanted{reference.hash_low, reference.hash_high};
  const detail::ContentHash found = detail::contentHash(pack.bytes());
  if (found == wanted) return {};
  // If the pack is damaged, linking again would only produce a list that accepts the damage.
  const auto payload = pack.bytes().subspan(sizeof(PackHeader));
  RETURN_IF_ERROR(checkPackHash(pack.header(), payload, pack.where()));
  return other(fmt::format("lists {}, whose hash is {:016x}{:016x}, expected {:016x}{:016x}",
                           pack.where(), found.high, found.low, wanted.high, wanted.low));
}

}  // namespace

Result<std::vector<PackReference>> packReferences(const PackFile& world) {
  ASSIGN_OR_RETURN(const auto content, contentOf(world));
  const schema::World* stored = content;
  std::vector<PackReference> references;
  references.reserve(stored->packs()->size());
  for (const schema::PackReference* one : *stored->packs()) {
    const auto kind = packKindOf(detail::fromSchema(one->kind()));
    if (!kind || one->hash() == nullptr) {  // Happens only if nothing was verified.
      return fail(ErrorCode::kInvalidInput, world.where(),
                  "has a damaged list of packs; open it without trusting it to learn more");
    }
    references.push_back({detail::fromSchema(one->path()), *kind, one->bytes(), one->hash()->low(),
                          one->hash()->high()});
  }
  return references;
}

Result<std::vector<OptionText>> taskOptions(const PackFile& world) {
  ASSIGN_OR_RETURN(const auto content, contentOf(world));
  const auto* stored = content->task();
  if (stored == nullptr) return {};
  // Passes if the pack was verified before; a trusted pack may hold anything.
  RETURN_IF_ERROR(detail::checkOptions(*stored, "task", world.where() + ": world"));
  std::vector<OptionText> options;
  options.reserve(stored->size());
  for (const OptionText& known : listOptions({}, OptionScope::kTask)) {
    if (options.size() == stored->size()) break;
    const schema::Option& next = *stored->Get(static_cast<flatbuffers::uoffset_t>(options.size()));
    if (detail::fromSchema(next.name()) != known.name) continue;
    options.push_back({known.name, next.value()->str(), known.is_word});
  }
  return options;
}

fs::path pathOf(const PackReference& reference, const PackFile& world) {
  return fs::path(world.where()).parent_path() / fs::path(reference.path);
}

Result<PackFile> openReference(const PackFile& world, const PackReference& reference, Trust trust) {
  const fs::path path = pathOf(reference, world);
  std::error_code ignored;
  if (fs::status(path, ignored).type() == fs::file_type::not_found) {
    return fail(ErrorCode::kInvalidInput, world.where(),
                fmt::format("lists {}, which is missing; put it there or link the world again",
                            path.string()),
                "world/missing-pack");
  }
  // Compare with the list first, to tell another pack from a damaged one. All on one mapping, so
  // that what is verified is what was compared.
  Result<PackFile> pack = PackFile::open(path, Trust::kTrusted);
  if (!pack) return pack;
  RETURN_IF_ERROR(checkLinked(*pack, reference, world.where(), trust));
  if (trust == Trust::kTrusted) return pack;
  RETURN_IF_ERROR(PackFile::view(pack->bytes(), pack->where(), trust));
  return pack;
}

}  // namespace galactic
