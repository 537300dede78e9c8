#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "galactic/error.h"

namespace galactic::bake {

using Json = nlohmann::json;

/// The expected kind of a JSON file, for messages and to limit its size.
struct JsonFileKind {
  /// For example "a collection".
  std::string_view what;
  /// The end of its name, for example ".collection.json".
  std::string_view suffix;
  std::size_t max_bytes = 0;
};

/// Fails with kInvalidInput if lists and objects are nested too deeply for recursive functions,
/// such as those with which Json copies and prints values.
[[nodiscard]] Result<void> checkNesting(std::string_view text, const std::string& where);

/// The JSON document in the file `path`, which may be compressed with gzip. Fails with kIo, with
/// kInvalidInput if it is not JSON or is (or decompresses to) more than `kind` allows, and like
/// checkNesting.
[[nodiscard]] Result<Json> readJsonFile(const std::filesystem::path& path,
                                        const JsonFileKind& kind);

/// A JSON value and its place, for example "collection.robots[0].gripper". Null if absent.
struct JsonNode {
  const Json* json = nullptr;
  std::string place;
};

/// Reads values out of an untrusted JSON document. The first error is kept; after it, all functions
/// return empty values, so that callers need to test only once, at the end or after a long list.
class JsonReader {
 public:
  explicit JsonReader(std::string file) : file_(std::move(file)) {}

  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] bool failed() const { return error_.has_value(); }
  /// Only after a failure.
  [[nodiscard]] tl::unexpected<Error> failure() const { return tl::unexpected<Error>(*error_); }
  /// One sentence for each unknown key, for its first occurrence.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

  void error(const std::string& place, std::string message);

  /// The member, or a null node if it is absent.
  [[nodiscard]] static JsonNode member(const JsonNode& object, const char* key);
  /// The member, whose absence is an error.
  [[nodiscard]] JsonNode require(const JsonNode& object, const char* key);
  /// The elements of a list; none if it is absent.
  [[nodiscard]] std::vector<JsonNode> elements(const JsonNode& list);
  [[nodiscard]] std::string text(const JsonNode& node);
  /// A truth value; false if it is absent.
  [[nodiscard]] bool flag(const JsonNode& node);
  /// A number from `min` to `max`.
  [[nodiscard]] double number(const JsonNode& node, double min, double max);
  /// A whole number from `min` to `max`.
  [[nodiscard]] std::int64_t whole(const JsonNode& node, std::int64_t min, std::int64_t max);
  /// Reads a list of exactly values.size() numbers from -`farthest` to `farthest`. Leaves `values`
  /// unchanged on an error.
  void numbers(const JsonNode& node, double farthest, std::span<double> values);
  template <std::size_t kCount>
  [[nodiscard]] std::array<double, kCount> vector(const JsonNode& node, double farthest) {
    std::array<double, kCount> values{};
    numbers(node, farthest, values);
    return values;
  }

  /// Warns of members that are not `known`, once for all elements of a list.
  void onlyKnown(const JsonNode& object, std::initializer_list<std::string_view> known);

 private:
  std::string file_;
  std::optional<Error> error_;
  std::vector<std::string> warnings_;
  /// Places, without indices, that a warning was given for.
  std::set<std::string> warned_;
};

}  // namespace galactic::bake
