#pragma once
#include <charconv>
#include <cstddef>
#include <optional>
#include <string_view>
#include <system_error>

namespace galactic::bake {

/// The words of a line, which are separated by blanks.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}

  /// The next word; empty at the end.
  std::string_view next() {
    constexpr std::string_view kBlanks = " \t\r\v\f";
    const std::size_t begin = rest_.find_first_not_of(kBlanks);
    if (begin == rest_.npos) {
      rest_ = {};
      return {};
    }
    rest_.remove_prefix(begin);
    const std::string_view word = rest_.substr(0, rest_.find_first_of(kBlanks));
    rest_.remove_prefix(word.size());
    return word;
  }

  /// The next word as a whole number; none if the word is missing or not a number.
  template <class Number>
  std::optional<Number> nextNumber() {
    const std::string_view word = next();
    Number number{};
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (word.empty() || problem != std::errc() || end != word.data() + word.size()) {
      return std::nullopt;
    }
    return number;
  }

  /// Number of words that are left.
  std::size_t count() {
    std::size_t words = 0;
    while (!next().empty()) ++words;
    return words;
  }

 private:
  std::string_view rest_;
};

/// The lines of a text one after the other, with any line end: \n, \r\n or \r.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}

  /// Moves to the next line; false at the end.
  bool next() {
    if (at_ >= text_.size()) return false;
    const std::size_t end = text_.find_first_of("\r\n", at_);
    has_end_ = end != text_.npos;
    line_ = text_.substr(at_, has_end_ ? end - at_ : text_.npos);
    at_ = has_end_ ? end + 1 : text_.size();
    if (has_end_ && text_[end] == '\r' && at_ < text_.size() && text_[at_] == '\n') ++at_;
    ++number_;
    return true;
  }

  /// Moves to the next line that has a word and does not begin with `comment`.
  bool nextFilled(char comment = '\0') {
    while (next()) {
      const std::string_view word = Words(line_).next();
      if (!word.empty() && word.front() != comment) return true;
    }
    return false;
  }

  /// The line without its end.
  [[nodiscard]] std::string_view line() const { return line_; }
  /// Number of the line, counted from 1.
  [[nodiscard]] std::size_t number() const { return number_; }
  /// Whether the line has a line end, rather than ending with the text.
  [[nodiscard]] bool hasEnd() const { return has_end_; }
  /// Offset of the text after the line.
  [[nodiscard]] std::size_t offset() const { return at_; }

 private:
  std::string_view text_;
  std::string_view line_;
  std::size_t at_ = 0;
  std::size_t number_ = 0;
  bool has_end_ = false;
};

}  // namespace galactic::bake
