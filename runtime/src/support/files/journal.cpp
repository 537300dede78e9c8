#include "support/files/journal.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

#include "support/content_hash.h"
#include "support/files/atomic_file.h"
#include "support/files/mapped_file.h"
#include "support/try.h"

namespace galactic {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "galactic journal\n";

/// Before each record: its size in decimal and its hash.
std::string headOf(std::string_view record) {
  const detail::ContentHash hash = detail::contentHash(std::as_bytes(std::span(record)));
  return fmt::format("{} {}\n", record.size(), detail::hexOf(hash));
}

/// The record at the beginning of `text`, between its head and the line break that ends it; none if
/// it is not whole.
std::optional<std::string_view> firstRecord(std::string_view text) {
  std::size_t size = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), size);
  const std::size_t head = text.find('\n');
  if (problem != std::errc() || head == std::string_view::npos) return std::nullopt;
  const std::string_view after = text.substr(head + 1);
  if (after.size() <= size || after[size] != '\n') return std::nullopt;
  const std::string_view record = after.substr(0, size);
  if (text.substr(0, head + 1) != headOf(record)) return std::nullopt;
  return record;
}

std::string asInFile(std::string_view record) {
  return fmt::format("{}{}\n", headOf(record), record);
}

}  // namespace

Result<std::unique_ptr<Journal>> Journal::open(const fs::path& path, std::string_view subject) {
  std::unique_ptr<Journal> journal(new Journal(path));
  RETURN_IF_ERROR(journal->read(subject));
  return journal;
}

Result<void> Journal::read(std::string_view subject) {
  kept_ = fmt::format("{}{}\n", kMagic, subject);
  std::error_code none;
  if (fs::status(path_, none).type() == fs::file_type::not_found) return {};
  ASSIGN_OR_RETURN(const auto file, MappedFile::open(path_));
  const std::string_view text(reinterpret_cast<const char*>(file.bytes().data()),
                              file.bytes().size());
  if (!kMagic.starts_with(text) && !text.starts_with(kMagic)) {
    return fail(ErrorCode::kInvalidInput, path_.string(),
                "is kept for what is done until the output is complete, but this file is of "
                "another kind, or of another version; move it, or give another output");
  }
  is_own_ = text.starts_with(kept_);
  if (!is_own_) return {};
  const std::size_t first = kept_.size();
  kept_ = text;
  std::size_t end = first;
  while (const auto record = firstRecord(std::string_view(kept_).substr(end))) {
    records_.push_back(*record);
    end = static_cast<std::size_t>(record->data() + record->size() + 1 - kept_.data());
  }
  // Shrinking does not move the text, which the records are views of.
  kept_.resize(end);
  return {};
}

Result<void> Journal::begin() {
  // Drops damaged records, and a journal of another subject.
  RETURN_IF_ERROR(writeFileAtomically(path_, kept_));
  is_own_ = true;
  stream_.open(path_, std::ios::binary | std::ios::app);
  return {};
}

Result<void> Journal::add(std::string_view record) {
  const std::string whole = asInFile(record);
  const std::lock_guard lock(mutex_);
  if (!stream_.is_open() && stream_) RETURN_IF_ERROR(begin());
  stream_ << whole << std::flush;
  if (stream_) return {};
  return fail(ErrorCode::kIo, path_.string(), "cannot be written; free some space");
}

void Journal::remove() {
  stream_.close();
  std::error_code none;
  if (is_own_) fs::remove(path_, none);
}

}  // namespace galactic
