#include "support/journal.h"

#include <fmt/format.h>

#include <charconv>
#include <iterator>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

#include "support/atomic_file.h"
#include "support/content_hash.h"
#include "support/try.h"

namespace galactic {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "galactic journal\n";

/// Before each record: its size in decimal and its hash.
std::string headOf(std::string_view record) {
  const detail::ContentHash hash = detail::contentHash(std::as_bytes(std::span(record)));
  return fmt::format("{} {:016x}{:016x}\n", record.size(), hash.high, hash.low);
}

/// The record with which `text` begins, as it stands in a file; none where it is not whole.
std::optional<std::string_view> firstRecord(std::string_view text) {
  std::size_t size = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), size);
  const std::size_t head = text.find('\n');
  if (problem != std::errc() || head == std::string_view::npos) return std::nullopt;
  const std::string_view after = text.substr(head + 1);
  // It ends with a line break of its own.
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
  ASSIGN_OR_RETURN(const std::string kept, journal->read(subject));
  // Without what is damaged or of another subject.
  RETURN_IF_ERROR(writeFileAtomically(path, {std::as_bytes(std::span(kept))}));
  journal->stream_.open(path, std::ios::binary | std::ios::app);
  if (journal->stream_) return journal;
  return fail(ErrorCode::kIo, path.string(), "cannot be written; check folder and rights");
}

Result<std::string> Journal::read(std::string_view subject) {
  std::string kept = fmt::format("{}{}\n", kMagic, subject);
  std::ifstream stream(path_, std::ios::binary);
  if (!stream) return kept;
  const std::string text(std::istreambuf_iterator<char>(stream), {});
  if (!text.empty() && !kMagic.starts_with(text) && !text.starts_with(kMagic)) {
    return fail(ErrorCode::kInvalidInput, path_.string(),
                "is kept for what is done until the output is complete, but this file is of "
                "another kind; move it, or give another output");
  }
  if (!text.starts_with(kept)) return kept;
  std::string_view rest = text;
  rest.remove_prefix(kept.size());
  while (const auto record = firstRecord(rest)) {
    records_.emplace_back(*record);
    const std::string whole = asInFile(*record);
    kept += whole;
    rest.remove_prefix(whole.size());
  }
  return kept;
}

Result<void> Journal::add(std::string_view record) {
  const std::string whole = asInFile(record);
  const std::lock_guard lock(mutex_);
  stream_ << whole << std::flush;
  if (stream_) return {};
  return fail(ErrorCode::kIo, path_.string(), "cannot be written; free some space");
}

void Journal::remove() {
  stream_.close();
  std::error_code none;
  fs::remove(path_, none);
}

}  // namespace galactic
