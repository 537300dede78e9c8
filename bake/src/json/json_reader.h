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

/// What a JSON file should be, for messages and as a bound of what is read.
struct JsonFileKind {
  /// For example "a collection".
  std::string_view what;
  /// How its name ends, for example ".collection.json".
  std::string_view suffix;
  std::size_t max_bytes = 0;
};

/// Fails with kInvalidInput where lists and objects lie deeper inside each other than functions
/// that call themselves can follow: Json's own, with which values are copied and printed.
[[nodiscard]] Result<void> checkNesting(std::string_view text, const std::string& where);

/// The JSON document in the file `path`, which may be compressed with gzip. Fails with kIo, and
/// with kInvalidInput when it is (or unpacks to be) larger than `kind` allows, or is no JSON, and
/// as checkNesting.
[[nodiscard]] Result<Json> readJsonFile(const std::filesystem::path& path,
                                        const JsonFileKind& kind);

/// A JSON value and where it stands, for example "collection.robots[0].gripper"; null when absent.
struct JsonNode {
  const Json* json = nullptr;
  std::string place;
};

/// Reads values out of a JSON document from strangers. The first offence is kept; from then on
/// readers return empty values, so that callers test once, at the end or after a long list.
class JsonReader {
 public:
  explicit JsonReader(std::string file) : file_(std::move(file)) {}

  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] bool failed() const { return error_.has_value(); }
  /// Only after a failure.
  [[nodiscard]] tl::unexpected<Error> failure() const { return tl::unexpected<Error>(*error_); }
  /// One sentence for each unused key, the first time that it is met.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

  void error(const std::string& place, std::string message);

  /// The member, or a null node when it is absent.
  [[nodiscard]] static JsonNode member(const JsonNode& object, const char* key);
  /// The same; its absence is an offence.
  [[nodiscard]] JsonNode require(const JsonNode& object, const char* key);
  /// The elements of a list; none of an absent one.
  [[nodiscard]] std::vector<JsonNode> elements(const JsonNode& list);
  [[nodiscard]] std::string text(const JsonNode& node);
  /// True or false; false of an absent one.
  [[nodiscard]] bool flag(const JsonNode& node);
  /// A number of `min` to `max`.
  [[nodiscard]] double number(const JsonNode& node, double min, double max);
  /// A whole number of `min` to `max`.
  [[nodiscard]] std::int64_t whole(const JsonNode& node, std::int64_t min, std::int64_t max);
  /// A list of exactly as many numbers of -`farthest` to `farthest` as `values` holds; they stay as
  /// they are on an offence.
  void numbers(const JsonNode& node, double farthest, std::span<double> values);
  template <std::size_t kCount>
  [[nodiscard]] std::array<double, kCount> vector(const JsonNode& node, double farthest) {
    std::array<double, kCount> values{};
    numbers(node, farthest, values);
    return values;
  }

  /// Warns of members that are not `known`; of the elements of a list once.
  void onlyKnown(const JsonNode& object, std::initializer_list<std::string_view> known);

 private:
  std::string file_;
  std::optional<Error> error_;
  std::vector<std::string> warnings_;
  /// Places without indices.
  std::set<std::string> warned_;
};

}  // namespace galactic::bake
