#include "view/json_writer.h"

#include <algorithm>
#include <array>

namespace galactic {
namespace {

/// Bytes of the UTF-8 character that `text` begins with; 0 when it begins with none.
std::size_t utf8Length(std::string_view text) {
  const auto byte = [&](std::size_t n) { return static_cast<unsigned char>(text[n]); };
  constexpr std::array<std::array<unsigned, 3>, 4> kLeads{
      {{0x00, 0x7F, 1}, {0xC2, 0xDF, 2}, {0xE0, 0xEF, 3}, {0xF0, 0xF4, 4}}};
  for (const auto& [first, last, length] : kLeads) {
    if (byte(0) < first || byte(0) > last) continue;
    if (text.size() < length) return 0;
    for (std::size_t n = 1; n < length; ++n) {
      if ((byte(n) & 0xC0U) != 0x80U) return 0;
    }
    return length;
  }
  return 0;
}

}  // namespace

std::string jsonString(std::string_view text) {
  std::string result = "\"";
  while (!text.empty()) {
    const std::size_t length = std::max<std::size_t>(utf8Length(text), 1);
    const std::string_view character = text.substr(0, length);
    const auto code = static_cast<unsigned char>(text.front());
    constexpr unsigned char kFirstPrintable = 0x20;
    if (code < kFirstPrintable) {
      result += fmt::format("\\u{:04x}", code);
    } else if (text.front() == '"' || text.front() == '\\') {
      result += '\\';
      result += text.front();
    } else {
      result += utf8Length(text) == 0 ? "?" : character;
    }
    text.remove_prefix(length);
  }
  return result + '"';
}

void JsonWriter::begin(char bracket) {
  text_ += bracket;
  is_first_ = true;
  ++depth_;
}

void JsonWriter::end(char bracket) {
  --depth_;
  if (!is_first_) newLine();
  text_ += bracket;
  is_first_ = false;
}

std::string JsonWriter::take() {
  if (layout_ == JsonLayout::kIndented) text_ += '\n';
  return std::move(text_);
}

void JsonWriter::newLine() {
  if (layout_ == JsonLayout::kCompact) return;
  text_ += '\n';
  text_.append(2 * depth_, ' ');
}

void JsonWriter::separate(std::string_view key) {
  if (!is_first_) text_ += ',';
  is_first_ = false;
  newLine();
  if (!key.empty()) text_ += jsonString(key) + (layout_ == JsonLayout::kCompact ? ":" : ": ");
}

}  // namespace galactic
