#include "galactic/pack.h"

#include <cstdint>
#include <utility>

#include "check/pack_check.h"
#include "galactic/schema/pack_generated.h"
#include "support/call_check.h"
#include "support/files/mapped_file.h"
#include "support/try.h"

namespace galactic {
namespace {

/// Alignment of the vectors in a pack, relative to the first byte of the file.
constexpr std::size_t kPackAlignment = 32;

}  // namespace

/// Keeps the file mapped; empty for a view of somebody else's memory.
class PackFile::Storage {
 public:
  explicit Storage(MappedFile file) : file_(std::move(file)) {}

 private:
  MappedFile file_;
};

PackFile::~PackFile() = default;

PackFile::PackFile(PackFile&& other) noexcept
    : storage_(std::move(other.storage_)),
      bytes_(std::exchange(other.bytes_, {})),
      header_(other.header_),
      root_(std::exchange(other.root_, nullptr)),
      where_(std::move(other.where_)) {}

PackFile& PackFile::operator=(PackFile&& other) noexcept {
  storage_ = std::move(other.storage_);
  bytes_ = std::exchange(other.bytes_, {});
  header_ = other.header_;
  root_ = std::exchange(other.root_, nullptr);
  where_ = std::move(other.where_);
  return *this;
}

const schema::Pack& PackFile::root() const {
  if (root_ == nullptr) detail::refuseCall("PackFile", "found a pack that was moved elsewhere");
  return *root_;
}

Result<PackFile> PackFile::open(const std::filesystem::path& path, Trust trust) {
  ASSIGN_OR_RETURN(MappedFile file, MappedFile::open(path));
  Result<PackFile> pack = view(file.bytes(), path.string(), trust);
  // Moving the mapping does not move the bytes that the pack points to.
  if (pack) pack->storage_ = std::make_unique<Storage>(std::move(file));
  return pack;
}

Result<PackFile> PackFile::view(std::span<const std::byte> file, std::string where, Trust trust) {
  if (reinterpret_cast<std::uintptr_t>(file.data()) % kPackAlignment != 0) {
    return fail(ErrorCode::kInvalidInput, std::move(where),
                "lies at an address that is not a multiple of 32; copy it to aligned memory",
                "pack/alignment");
  }
  ASSIGN_OR_RETURN(PackHeader header, readPackHeader(file, where));
  const auto payload = file.subspan(sizeof(PackHeader));
  Result<void> checked = detail::checkPayloadStart(payload, where);
  if (trust == Trust::kVerify) {
    // The hash comes first, to tell a damaged file from one that was written wrongly.
    if (auto intact = checkPackHash(header, payload, where); !intact) checked = intact;
    if (checked) checked = detail::checkPack(header, file, where);
  }
  if (!checked) return tl::unexpected<Error>(std::move(checked.error()));
  PackFile pack;
  pack.bytes_ = file;
  pack.header_ = header;
  pack.root_ = schema::GetPack(payload.data());
  pack.where_ = std::move(where);
  return pack;
}

}  // namespace galactic
