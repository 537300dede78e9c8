#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>

#include "import/checks/content_check.h"
#include "import/checks/text_lines.h"

namespace galactic::bake {
namespace {

tl::unexpected<Error> cutOff(const std::string& where, const std::string& message) {
  return fail(ErrorCode::kInvalidInput, where,
              message + "; the file is cut off or damaged: export or download it again");
}

/// A number for the form of a corner of an OBJ's face (v, v/t, v//n or v/t/n): it encodes the
/// number of slashes, whether there is something between them, and whether there is something after
/// the last.
unsigned cornerForm(std::string_view corner) {
  const auto slashes = static_cast<unsigned>(std::count(corner.begin(), corner.end(), '/'));
  const bool is_whole = !corner.empty() && corner.back() != '/';
  return 4 * slashes + (corner.find("//") != corner.npos ? 2U : 0U) + (is_whole ? 1U : 0U);
}

bool areAlike(Words corners) {
  const std::string_view first = corners.next();
  const unsigned form = cornerForm(first);
  std::size_t count = first.empty() ? 0 : 1;
  for (std::string_view next = corners.next(); !next.empty(); next = corners.next(), ++count) {
    if (cornerForm(next) != form) return false;
  }
  return count >= 3 && form % 2 == 1;
}

/// Whether the last line of an OBJ can be a complete statement.
bool canEndObj(std::string_view line) {
  Words words(line);
  const std::string_view keyword = words.next();
  if (keyword.empty() || keyword.front() == '#') return true;
  if (keyword == "f") return areAlike(words);
  const std::size_t count = words.count();
  if (keyword == "v" || keyword == "vn") return count >= 3;
  if (keyword == "vt") return count >= 2;
  return (keyword == "l" && count >= 2) || (keyword == "p" && count >= 1) ||
         (keyword == "s" && count == 1);
}

/// The largest vertex that the face uses; relative (negative) indices count as 0.
std::uint64_t largestVertex(Words corners) {
  std::uint64_t largest = 0;
  for (std::string_view corner = corners.next(); !corner.empty(); corner = corners.next()) {
    Words vertex(corner.substr(0, corner.find('/')));
    largest = std::max(largest, vertex.nextNumber<std::uint64_t>().value_or(0));
  }
  return largest;
}

/// The first of `numbers` that is like .5; empty if there is none. The reader ends the line there,
/// and drops the vertex, which shifts all later ones.
std::string_view numberWithoutDigit(Words numbers) {
  for (std::string_view n = numbers.next(); !n.empty(); n = numbers.next()) {
    if (n.front() == '#') break;
    if (n.front() == '.') return n;
  }
  return {};
}

bool isStlText(std::string_view file) {
  constexpr std::string_view kSolid = "solid";
  constexpr std::size_t kLookedAt = 500;
  const std::size_t begin = file.find_first_not_of(" \t\r\n");
  if (begin == file.npos || !file.substr(begin).starts_with(kSolid)) return false;
  const std::string_view head = file.substr(0, kLookedAt);
  return std::all_of(head.begin(), head.end(),
                     [](char c) { return c != '\0' && static_cast<unsigned char>(c) < 128; });
}

Result<void> checkStlText(std::string_view file, const std::string& where) {
  std::uint64_t open_solids = 0;
  std::uint64_t facets = 0;
  std::uint64_t closed_facets = 0;
  std::uint64_t vertices = 0;
  for (Lines lines(file); lines.next();) {
    Words words(lines.line());
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      // What follows is a name, which may be anything.
      if (word == "solid") {
        ++open_solids;
        break;
      }
      if (word == "endsolid") {
        open_solids -= std::min<std::uint64_t>(open_solids, 1);
        break;
      }
      facets += word == "facet" ? 1U : 0U;
      closed_facets += word == "endfacet" ? 1U : 0U;
      vertices += word == "vertex" ? 1U : 0U;
    }
  }
  if (open_solids > 0) return cutOff(where, "its last solid has no endsolid");
  if (facets == closed_facets && vertices == 3 * facets) return {};
  return cutOff(where, fmt::format("it has {} facets, {} of which are closed, and {} vertices, "
                                   "expected three of each",
                                   facets, closed_facets, vertices));
}

Result<void> checkStlBinary(std::string_view file, const std::string& where) {
  constexpr std::size_t kHead = 84;
  constexpr std::size_t kCountAt = 80;
  constexpr std::uint64_t kTriangle = 50;
  if (file.size() < kHead) {
    return cutOff(
        where, fmt::format("a binary STL has at least {} bytes, this one {}", kHead, file.size()));
  }
  std::uint32_t stated = 0;
  std::memcpy(&stated, file.data() + kCountAt, sizeof(stated));
  if (file.size() == kHead + kTriangle * stated) return {};
  return cutOff(where, fmt::format("it states {} triangles, and its {} bytes hold {}", stated,
                                   file.size(), (file.size() - kHead) / kTriangle));
}

/// Each of these files is looked for, read and reported; real files name one.
constexpr std::size_t kMostLibraries = 1000;

/// Checks that an OFF file has as many vertices and faces as it states.
class OffCounter {
 public:
  OffCounter(std::string_view file, const std::string& where) : lines_(file), where_(where) {}

  Result<void> check() {
    const auto counts = readCounts();
    if (!counts) return cutOff(where_, "it has no line of three counts");
    const auto [vertices, faces] = *counts;
    for (std::uint64_t n = 0; n < vertices; ++n) {
      if (!lines_.nextFilled('#')) return tooFew("vertices", vertices, n);
      if (Words(lines_.line()).count() < 3) return tooFew("vertices", vertices, n);
    }
    for (std::uint64_t n = 0; n < faces; ++n) {
      if (!lines_.nextFilled('#')) return tooFew("faces", faces, n);
      Words words(lines_.line());
      const auto corners = words.nextNumber<std::uint64_t>();
      if (!corners || words.count() < *corners) return tooFew("faces", faces, n);
    }
    if (!lines_.nextFilled('#')) return {};
    return cutOff(where_, fmt::format("it goes on behind the {} faces that it states", faces));
  }

 private:
  using Counts = std::optional<std::pair<std::uint64_t, std::uint64_t>>;

  /// The numbers follow the word OFF, or are on a line of their own; the word may be absent.
  Counts readCounts() {
    while (lines_.nextFilled('#')) {
      Words words(lines_.line());
      if (lines_.line().find("OFF") != std::string_view::npos) {
        (void)words.next();
        if (Words(words).next().empty()) continue;
      }
      const auto vertices = words.nextNumber<std::uint64_t>();
      const auto faces = words.nextNumber<std::uint64_t>();
      if (!vertices || !faces) return std::nullopt;
      return std::pair(*vertices, *faces);
    }
    return std::nullopt;
  }

  [[nodiscard]] tl::unexpected<Error> tooFew(const char* what, std::uint64_t stated,
                                             std::uint64_t found) const {
    return cutOff(where_,
                  fmt::format("it states {} {}, and has {} whole ones", stated, what, found));
  }

  Lines lines_;
  const std::string& where_;
};

}  // namespace

Result<void> checkObj(std::string_view file, const std::string& where) {
  std::uint64_t vertices = 0;
  std::uint64_t largest = 0;
  std::size_t libraries = 0;
  std::size_t line_of_largest = 0;
  Lines lines(file);
  while (lines.next()) {
    Words words(lines.line());
    const std::string_view keyword = words.next();
    if (keyword == "v") ++vertices;
    if (keyword == "v" || keyword == "vt" || keyword == "vn") {
      const std::string_view number = numberWithoutDigit(words);
      if (!number.empty()) {
        return fail(ErrorCode::kInvalidInput, where,
                    fmt::format("line {} has the number '{}', which the reader of .obj files does "
                                "not take; write it as '0{}', or convert it to GLB",
                                lines.number(), number, number));
      }
    }
    if (keyword == "mtllib" && ++libraries > kMostLibraries) {
      return fail(ErrorCode::kInvalidInput, where,
                  fmt::format("it names more than {} material files, at most so many are read; "
                              "export it with one",
                              kMostLibraries));
    }
    if (keyword != "f") continue;
    const std::uint64_t vertex = largestVertex(words);
    if (vertex > largest) line_of_largest = lines.number();
    largest = std::max(largest, vertex);
  }
  if (!lines.hasEnd() && !canEndObj(lines.line())) {
    return cutOff(where, fmt::format("it ends inside line {}", lines.number()));
  }
  if (largest <= vertices) return {};
  return cutOff(where, fmt::format("line {} uses vertex {}, and it has {}", line_of_largest,
                                   largest, vertices));
}

Result<void> checkStl(std::string_view file, const std::string& where) {
  // Some binary files begin with "solid", too.
  const auto binary = checkStlBinary(file, where);
  return binary || !isStlText(file) ? binary : checkStlText(file, where);
}

Result<void> checkOff(std::string_view file, const std::string& where) {
  return OffCounter(file, where).check();
}

}  // namespace galactic::bake
