#include "view/json_writer.h"

#include <algorithm>
#include <array>

namespace galactic {
namespace {

/// Characters of UTF-8 by the range of their first byte, and that of their second: the table of
/// well-formed sequences in the Unicode standard (chapter 3, table 3-7). All other bytes
/// are 80..BF.
struct Utf8Form {
  unsigned first, last;
  std::size_t length;
  unsigned least_second, most_second;
};
constexpr std::array<Utf8Form, 9> kUtf8Forms{{{0x00, 0x7F, 1, 0, 0},
                                              {0xC2, 0xDF, 2, 0x80, 0xBF},
                                              {0xE0, 0xE0, 3, 0xA0, 0xBF},
                                              {0xE1, 0xEC, 3, 0x80, 0xBF},
                                              {0xED, 0xED, 3, 0x80, 0x9F},
                                              {0xEE, 0xEF, 3, 0x80, 0xBF},
                                              {0xF0, 0xF0, 4, 0x90, 0xBF},
                                              {0xF1, 0xF3, 4, 0x80, 0xBF},
                                              {0xF4, 0xF4, 4, 0x80, 0x8F}}};

/// Bytes of the UTF-8 character that `text` begins with; 0 when it begins with none.
std::size_t utf8Length(std::string_view text) {
  const auto byte = [&](std::size_t n) { return static_cast<unsigned char>(text[n]); };
  for (const Utf8Form& form : kUtf8Forms) {
    if (byte(0) < form.first || byte(0) > form.last) continue;
    if (text.size() < form.length) return 0;
    if (form.length == 1) return 1;
    if (byte(1) < form.least_second || byte(1) > form.most_second) return 0;
    for (std::size_t n = 2; n < form.length; ++n) {
      if ((byte(n) & 0xC0U) != 0x80U) return 0;
    }
    return form.length;
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
