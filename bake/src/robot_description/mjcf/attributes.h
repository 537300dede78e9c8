#pragma once
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/bake/source_asset.h"
#include "galactic/error.h"
#include "robot_description/mjcf/xml_tree.h"

namespace galactic::bake {

/// What is found out while an MJCF is read: the first error, after which nothing counts, and what
/// to warn of.
class MjcfFindings {
 public:
  void error(const std::string& place, std::string message,
             ErrorCode code = ErrorCode::kInvalidInput) {
    if (!error_) error_ = Error{code, place, std::move(message)};
  }
  /// Each sentence once.
  void warn(std::string sentence) {
    if (told_.insert(sentence).second) warnings_.push_back(std::move(sentence));
  }

  [[nodiscard]] const std::optional<Error>& firstError() const { return error_; }
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  std::optional<Error> error_;
  std::vector<std::string> warnings_;
  std::set<std::string> told_;
};

using AttributeMap = std::map<std::string, std::string, std::less<>>;

/// The attributes of one element, its class's included. What is malformed is an error, and answered
/// with nothing or with the fallback.
class MjcfAttributes {
 public:
  MjcfAttributes(const XmlElement& element, AttributeMap values, MjcfFindings& findings)
      : element_(element), values_(std::move(values)), findings_(findings) {}

  [[nodiscard]] const XmlElement& element() const { return element_; }
  [[nodiscard]] MjcfFindings& findings() const { return findings_; }
  [[nodiscard]] bool has(std::string_view name) const { return find(name) != nullptr; }
  /// Null where it is absent.
  [[nodiscard]] const std::string* find(std::string_view name) const;
  /// Empty where it is absent.
  [[nodiscard]] std::string text(std::string_view name) const;

  /// `least` to `most` finite numbers; none where it is absent.
  [[nodiscard]] std::optional<std::vector<double>> numbers(std::string_view name, std::size_t least,
                                                           std::size_t most) const;
  template <std::size_t kCount>
  [[nodiscard]] std::optional<std::array<double, kCount>> vector(std::string_view name) const {
    const auto list = numbers(name, kCount, kCount);
    if (!list) return std::nullopt;
    std::array<double, kCount> array{};
    for (std::size_t n = 0; n < kCount; ++n) array[n] = (*list)[n];
    return array;
  }
  [[nodiscard]] double number(std::string_view name, double fallback) const;
  /// One of `words`, by its index.
  [[nodiscard]] std::size_t choice(std::string_view name, std::span<const std::string_view> words,
                                   std::size_t fallback) const;
  [[nodiscard]] bool flag(std::string_view name, bool fallback) const;

  void error(std::string_view name, std::string_view expected) const;

 private:
  const XmlElement& element_;
  AttributeMap values_;
  MjcfFindings& findings_;
};

/// The classes of an MJCF's <default> elements: what attributes they give to elements.
class MjcfDefaults {
 public:
  explicit MjcfDefaults(MjcfFindings& findings) : findings_(findings) {}

  [[nodiscard]] MjcfFindings& findings() const { return findings_; }

  /// A <default> that is in none.
  void add(const XmlElement& outermost);

  /// Of an element that has no class itself, `inherited` counts (childclass; empty: none).
  [[nodiscard]] MjcfAttributes attributesOf(const XmlElement& element,
                                            const std::string& inherited) const;

 private:
  /// Attributes by the name of the element that gets them.
  using ElementDefaults = std::map<std::string, AttributeMap, std::less<>>;

  void fill(const XmlElement& source, const std::string& name);

  MjcfFindings& findings_;
  /// That of no name has what all have.
  std::map<std::string, ElementDefaults, std::less<>> classes_{{"", {}}};
  /// How else that one is called.
  std::set<std::string, std::less<>> names_of_all_{"main"};
};

/// What <compiler> says of the meaning of others.
struct MjcfSettings {
  bool in_degrees = true;
  std::string euler_sequence = "xyz";
  bool auto_limits = true;
  std::string mesh_folder;
  std::string texture_folder;
  bool strips_paths = false;
  /// Whether masses come from shapes always, never, or where there is no <inertial>.
  enum class Inertias { kFromShapes, kStated, kStatedOrFromShapes };
  Inertias inertias = Inertias::kStatedOrFromShapes;
  /// Groups of the shapes that have mass.
  std::array<double, 2> massive_groups{0, 5};
  /// Kilograms of the whole robot; without, as the rest says.
  std::optional<double> total_mass;

  /// An angle of the text in radians.
  [[nodiscard]] double radians(double angle) const;
  /// What a later <compiler> says replaces what one before it says.
  void read(const MjcfAttributes& compiler);
};

/// Where an element is: pos, and quat, axisangle, euler, xyaxes or zaxis.
[[nodiscard]] Affine poseOf(const MjcfAttributes& attributes, const MjcfSettings& settings);

/// A rotation by `angle` (radians) about `axis`, of any length but 0.
[[nodiscard]] Affine rotationAbout(const std::array<double, 3>& axis, double angle);
/// The least rotation that takes Z to `direction`, of any length but 0.
[[nodiscard]] Affine rotationOfZ(const std::array<double, 3>& direction);
/// That of a quaternion w, x, y, z of any length but 0.
[[nodiscard]] Affine rotationOf(const std::array<double, 4>& quaternion);
[[nodiscard]] Affine translationOf(const std::array<double, 3>& offset);

}  // namespace galactic::bake
