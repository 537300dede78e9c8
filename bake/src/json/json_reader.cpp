#include "json/json_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <system_error>

#include "json/gzip.h"
#include "support/files/mapped_file.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// Turns "a.b[17].c" into "a.b[].c", which is the same for all elements of a list.
std::string withoutIndices(std::string_view place) {
  std::string plain;
  bool inside = false;
  for (const char c : place) {
    if (c == ']') inside = false;
    if (!inside) plain += c;
    if (c == '[') inside = true;
  }
  return plain;
}

/// Maximum nesting depth of lists and objects, because recursive functions copy and print values.
constexpr int kMostNesting = 100;

}  // namespace

Result<void> checkNesting(std::string_view text, const std::string& where) {
  int depth = 0;
  bool is_quoted = false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (is_quoted && c == '\\') ++at;
    if (c == '"') is_quoted = !is_quoted;
    if (is_quoted) continue;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > kMostNesting) {
      return fail(ErrorCode::kInvalidInput, where,
                  fmt::format("its lists and objects lie more than {} deep inside each other; "
                              "export it again",
                              kMostNesting));
    }
  }
  return {};
}

Result<Json> readJsonFile(const std::filesystem::path& path, const JsonFileKind& kind) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    return fail(ErrorCode::kIo, path.string(),
                fmt::format("it is a folder; give the path of a {} file", kind.suffix));
  }
  ASSIGN_OR_RETURN(const auto file, MappedFile::open(path));
  std::string unpacked;
  std::string_view text(reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size());
  if (isGzip(file.bytes())) {
    ASSIGN_OR_RETURN(auto inside, gunzip(file.bytes(), path.string(), kind.max_bytes));
    unpacked = std::move(inside);
    text = unpacked;
  }
  if (text.size() > kind.max_bytes) {
    return fail(ErrorCode::kInvalidInput, path.string(),
                fmt::format("it has {} bytes, at most {} are read; is it {}?", text.size(),
                            kind.max_bytes, kind.what));
  }
  RETURN_IF_ERROR(checkNesting(text, path.string()));
  try {
    return Json::parse(text);
  } catch (const Json::exception& error) {
    return fail(ErrorCode::kInvalidInput, path.string(),
                fmt::format("it is not JSON: {}", error.what()));
  }
}

void JsonReader::error(const std::string& place, std::string message) {
  if (error_) return;
  error_ = Error{ErrorCode::kInvalidInput, fmt::format("{}: {}", file_, place), std::move(message)};
}

JsonNode JsonReader::member(const JsonNode& object, const char* key) {
  JsonNode node{nullptr, object.place.empty() ? key : fmt::format("{}.{}", object.place, key)};
  if (object.json == nullptr || !object.json->is_object()) return node;
  const auto found = object.json->find(key);
  if (found != object.json->end()) node.json = &*found;
  return node;
}

JsonNode JsonReader::require(const JsonNode& object, const char* key) {
  JsonNode node = member(object, key);
  if (node.json == nullptr) error(node.place, "it is missing");
  return node;
}

std::vector<JsonNode> JsonReader::elements(const JsonNode& list) {
  std::vector<JsonNode> nodes;
  if (list.json == nullptr) return nodes;
  if (!list.json->is_array()) error(list.place, "expected a list");
  if (error_) return nodes;
  nodes.reserve(list.json->size());
  for (std::size_t i = 0; i < list.json->size(); ++i) {
    nodes.push_back({&(*list.json)[i], fmt::format("{}[{}]", list.place, i)});
  }
  return nodes;
}

std::string JsonReader::text(const JsonNode& node) {
  if (node.json != nullptr && node.json->is_string()) return node.json->get<std::string>();
  if (node.json != nullptr) error(node.place, "expected a string");
  return {};
}

bool JsonReader::flag(const JsonNode& node) {
  if (node.json != nullptr && node.json->is_boolean()) return node.json->get<bool>();
  if (node.json != nullptr) error(node.place, "expected true or false");
  return false;
}

double JsonReader::number(const JsonNode& node, double min, double max) {
  if (node.json == nullptr) return 0;
  if (!node.json->is_number()) {
    error(node.place, "expected a number");
    return 0;
  }
  const double value = node.json->get<double>();
  if (value >= min && value <= max) return value;
  error(node.place, fmt::format("found {}, expected {} to {}", value, min, max));
  return 0;
}

std::int64_t JsonReader::whole(const JsonNode& node, std::int64_t min, std::int64_t max) {
  if (node.json == nullptr) return 0;
  if (!node.json->is_number_integer()) {
    error(node.place, "expected a whole number");
    return 0;
  }
  // Values beyond the signed range would wrap around.
  const bool huge = node.json->is_number_unsigned() &&
                    node.json->get<std::uint64_t>() > static_cast<std::uint64_t>(INT64_MAX);
  const std::int64_t value = huge ? INT64_MAX : node.json->get<std::int64_t>();
  if (value >= min && value <= max) return value;
  error(node.place, fmt::format("found {}, expected {} to {}", node.json->dump(), min, max));
  return 0;
}

void JsonReader::numbers(const JsonNode& node, double farthest, std::span<double> values) {
  if (node.json == nullptr || error_) return;
  if (!node.json->is_array()) return error(node.place, "expected a list");
  if (node.json->size() != values.size()) {
    return error(node.place,
                 fmt::format("it has {} numbers, expected {}", node.json->size(), values.size()));
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Json& element = (*node.json)[i];
    const double value = element.is_number() ? element.get<double>() : HUGE_VAL;
    if (value >= -farthest && value <= farthest) {
      values[i] = value;
      continue;
    }
    // number() reports the element's place on an error.
    values[i] = number({&element, fmt::format("{}[{}]", node.place, i)}, -farthest, farthest);
  }
}

void JsonReader::onlyKnown(const JsonNode& object, std::initializer_list<std::string_view> known) {
  if (object.json == nullptr || !object.json->is_object()) return;
  for (auto item = object.json->begin(); item != object.json->end(); ++item) {
    if (std::find(known.begin(), known.end(), item.key()) != known.end()) continue;
    const std::string place = fmt::format("{}.{}", object.place, item.key());
    if (!warned_.insert(withoutIndices(place)).second) continue;
    warnings_.push_back(place + " is not used");
  }
}

}  // namespace galactic::bake
