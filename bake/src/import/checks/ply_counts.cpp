#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "import/checks/content_check.h"
#include "import/checks/text_lines.h"

namespace galactic::bake {
namespace {

struct ScalarType {
  std::string_view name;
  std::size_t bytes = 0;
  bool is_signed = false;
};

constexpr std::array kScalarTypes{
    ScalarType{"char", 1, true},   ScalarType{"int8", 1, true},    ScalarType{"uchar", 1},
    ScalarType{"uint8", 1},        ScalarType{"short", 2, true},   ScalarType{"int16", 2, true},
    ScalarType{"ushort", 2},       ScalarType{"uint16", 2},        ScalarType{"int", 4, true},
    ScalarType{"int32", 4, true},  ScalarType{"uint", 4},          ScalarType{"uint32", 4},
    ScalarType{"float", 4, true},  ScalarType{"float32", 4, true}, ScalarType{"double", 8, true},
    ScalarType{"float64", 8, true}};

const ScalarType* scalarType(std::string_view name) {
  const auto* found = std::find_if(kScalarTypes.begin(), kScalarTypes.end(),
                                   [&](const ScalarType& type) { return type.name == name; });
  return found == kScalarTypes.end() ? nullptr : found;
}

struct Property {
  const ScalarType* type = nullptr;
  /// Type of the length, if the property is a list.
  const ScalarType* length = nullptr;
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

enum class Encoding { kAscii, kLittleEndian, kBigEndian };

struct Header {
  Encoding encoding = Encoding::kAscii;
  std::vector<Element> elements;
  /// Offset of the first element.
  std::size_t size = 0;
};

/// None for a header that only the reader can judge.
using FoundHeader = std::optional<Header>;

bool isPly(std::string_view file) {
  constexpr std::string_view kMagic = "ply";
  return file.size() >= kMagic.size() &&
         std::equal(kMagic.begin(), kMagic.end(), file.begin(), [](char a, char b) {
           return a == std::tolower(static_cast<unsigned char>(b));
         });
}

std::optional<Encoding> encodingOf(std::string_view name) {
  if (name == "ascii") return Encoding::kAscii;
  if (name == "binary_little_endian") return Encoding::kLittleEndian;
  if (name == "binary_big_endian") return Encoding::kBigEndian;
  return std::nullopt;
}

std::optional<Property> propertyOf(Words& words) {
  Property property;
  std::string_view word = words.next();
  if (word == "list") {
    property.length = scalarType(words.next());
    if (property.length == nullptr) return std::nullopt;
    word = words.next();
  }
  property.type = scalarType(word);
  if (property.type == nullptr) return std::nullopt;
  return property;
}

class PlyCounter {
 public:
  PlyCounter(std::string_view file, const std::string& where) : file_(file), where_(where) {}

  Result<void> check() const {
    const auto header = readHeader();
    if (!header) return tl::unexpected(header.error());
    if (!*header) return {};
    return (*header)->encoding == Encoding::kAscii ? checkText(**header) : checkBinary(**header);
  }

 private:
  [[nodiscard]] tl::unexpected<Error> broken(const std::string& message) const {
    return fail(ErrorCode::kInvalidInput, where_,
                message + "; the file is cut off or damaged: export or download it again");
  }

  [[nodiscard]] tl::unexpected<Error> tooFew(const Element& element, std::uint64_t found) const {
    return broken(fmt::format("its PLY header states {} of element {}, and the file ends after {}",
                              element.count, element.name, found));
  }

  [[nodiscard]] tl::unexpected<Error> tooMany(const Header& header) const {
    return broken(fmt::format("it goes on behind the {} of element {} that its PLY header states",
                              header.elements.back().count, header.elements.back().name));
  }

  [[nodiscard]] Result<FoundHeader> readHeader() const {
    Header header;
    bool is_known = false;
    for (Lines lines(file_); lines.next();) {
      // The reader's time grows with the square of the number of lines.
      if (lines.number() > kMostHeaderLines) {
        return fail(ErrorCode::kInvalidInput, where_,
                    fmt::format("its PLY header has more than {} lines, at most so many are read; "
                                "remove its comments",
                                kMostHeaderLines));
      }
      Words words(lines.line());
      const std::string_view keyword = words.next();
      if (keyword == "end_header" && lines.hasEnd()) {
        header.size = lines.offset();
        if (!is_known || header.elements.empty()) return FoundHeader();
        return FoundHeader(std::move(header));
      }
      if (keyword == "format") {
        const auto encoding = encodingOf(words.next());
        is_known = encoding.has_value();
        if (encoding) header.encoding = *encoding;
      } else if (keyword == "element") {
        const std::string_view name = words.next();
        const auto count = words.nextNumber<std::uint64_t>();
        if (!count)
          return broken(fmt::format("line {} of its PLY header has no count", lines.number()));
        header.elements.push_back({std::string(name), *count, {}});
      } else if (keyword == "property") {
        const auto property = propertyOf(words);
        if (!property || header.elements.empty())
          return broken(
              fmt::format("line {} of its PLY header names no known type", lines.number()));
        header.elements.back().properties.push_back(*property);
      }
    }
    return fail(ErrorCode::kInvalidInput, where_,
                "its PLY header has no end_header line; the file is cut off: export or download it "
                "again");
  }

  /// In a text file each element is a line.
  [[nodiscard]] Result<void> checkText(const Header& header) const {
    Lines lines(file_.substr(header.size));
    for (const Element& element : header.elements) {
      if (element.properties.empty()) continue;
      for (std::uint64_t n = 0; n < element.count; ++n) {
        if (!lines.nextFilled()) return tooFew(element, n);
        if (holds(lines.line(), element)) continue;
        return broken(fmt::format("{} {} ends early in \"{}\"", element.name, n,
                                  lines.line().substr(0, kQuotedCharacters)));
      }
    }
    return lines.nextFilled() ? Result<void>(tooMany(header)) : Result<void>{};
  }

  /// Whether a line has all the words of an element.
  [[nodiscard]] static bool holds(std::string_view line, const Element& element) {
    Words words(line);
    for (const Property& property : element.properties) {
      std::uint64_t items = 1;
      if (property.length != nullptr) {
        const auto length = words.nextNumber<std::uint64_t>();
        if (!length) return false;
        items = *length;
      }
      for (; items > 0; --items) {
        if (words.next().empty()) return false;
      }
    }
    return true;
  }

  [[nodiscard]] Result<void> checkBinary(const Header& header) const {
    std::string_view rest = file_.substr(header.size);
    for (const Element& element : header.elements) {
      const std::size_t fixed = fixedBytes(element);
      if (fixed != 0 || element.properties.empty()) {
        if (fixed != 0 && rest.size() / fixed < element.count) {
          return tooFew(element, rest.size() / fixed);
        }
        rest.remove_prefix(static_cast<std::size_t>(element.count) * fixed);
        continue;
      }
      for (std::uint64_t n = 0; n < element.count; ++n) {
        if (!skip(element, header.encoding, rest)) return tooFew(element, n);
      }
    }
    // A few bytes after the last element are padding, or a line end.
    const bool another_fits = rest.size() >= leastBytes(header.elements.back());
    return another_fits ? Result<void>(tooMany(header)) : Result<void>{};
  }

  /// Size in bytes of an element; 0 if it has lists.
  [[nodiscard]] static std::size_t fixedBytes(const Element& element) {
    std::size_t bytes = 0;
    for (const Property& property : element.properties) {
      if (property.length != nullptr) return 0;
      bytes += property.type->bytes;
    }
    return bytes;
  }

  /// Least size in bytes of an element, whose lists are triangles.
  [[nodiscard]] static std::size_t leastBytes(const Element& element) {
    std::size_t bytes = 0;
    for (const Property& property : element.properties) {
      bytes += property.length == nullptr ? property.type->bytes
                                          : property.length->bytes + 3 * property.type->bytes;
    }
    return std::max<std::size_t>(bytes, 1);
  }

  [[nodiscard]] static bool skip(const Element& element, Encoding encoding,
                                 std::string_view& rest) {
    for (const Property& property : element.properties) {
      std::uint64_t items = 1;
      if (property.length != nullptr) {
        if (rest.size() < property.length->bytes) return false;
        items = wordOf(rest.substr(0, property.length->bytes), encoding);
        rest.remove_prefix(property.length->bytes);
      }
      if (rest.size() / property.type->bytes < items) return false;
      rest.remove_prefix(static_cast<std::size_t>(items) * property.type->bytes);
    }
    return true;
  }

  /// A negative length reads as a huge one, which no file holds.
  [[nodiscard]] static std::uint64_t wordOf(std::string_view bytes, Encoding encoding) {
    std::uint64_t word = 0;
    for (std::size_t n = 0; n < bytes.size(); ++n) {
      const std::size_t at = encoding == Encoding::kBigEndian ? n : bytes.size() - 1 - n;
      word = word << 8U | static_cast<unsigned char>(bytes[at]);
    }
    return word;
  }

  static constexpr std::size_t kQuotedCharacters = 40;
  static constexpr std::size_t kMostHeaderLines = 10'000;

  std::string_view file_;
  const std::string& where_;
};

}  // namespace

Result<void> checkPlyCounts(std::string_view file, const std::string& where) {
  return isPly(file) ? PlyCounter(file, where).check() : Result<void>{};
}

}  // namespace galactic::bake
