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

/// Collects findings while an MJCF is read: the first error, which makes everything after it void,
/// and the warnings.
class MjcfFindings {
 public:
  void error(const std::string& place, std::string message,
             ErrorCode code = ErrorCode::kInvalidInput) {
    if (!error_) error_ = Error{code, place, std::move(message)};
  }
  /// Adds each sentence only once.
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

/// The attributes of one element, including those from its class. A malformed value is reported as
/// an error; the getter then returns none, or the fallback.
class MjcfAttributes {
 public:
  MjcfAttributes(const XmlElement& element, AttributeMap values, MjcfFindings& findings)
      : element_(element), values_(std::move(values)), findings_(findings) {}

  [[nodiscard]] const XmlElement& element() const { return element_; }
  [[nodiscard]] MjcfFindings& findings() const { return findings_; }
  [[nodiscard]] bool has(std::string_view name) const { return find(name) != nullptr; }
  /// Null if absent.
  [[nodiscard]] const std::string* find(std::string_view name) const;
  /// Empty if absent.
  [[nodiscard]] std::string text(std::string_view name) const;

  /// From `least` to `most` finite numbers; none if absent.
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
  /// The index of the value in `words`.
  [[nodiscard]] std::size_t choice(std::string_view name, std::span<const std::string_view> words,
                                   std::size_t fallback) const;
  [[nodiscard]] bool flag(std::string_view name, bool fallback) const;

  void error(std::string_view name, std::string_view expected) const;

 private:
  const XmlElement& element_;
  AttributeMap values_;
  MjcfFindings& findings_;
};

/// The classes of an MJCF's <default> elements: the attributes that they give to elements.
class MjcfDefaults {
 public:
  explicit MjcfDefaults(MjcfFindings& findings) : findings_(findings) {}

  [[nodiscard]] MjcfFindings& findings() const { return findings_; }

  /// Adds a <default> that is not inside another.
  void add(const XmlElement& outermost);

  /// `inherited` is the class of elements that state none (childclass; empty if there is none).
  [[nodiscard]] MjcfAttributes attributesOf(const XmlElement& element,
                                            const std::string& inherited) const;

 private:
  /// Attributes by the name of the elements that they apply to.
  using ElementDefaults = std::map<std::string, AttributeMap, std::less<>>;

  void fill(const XmlElement& source, const std::string& name);

  MjcfFindings& findings_;
  /// The class with the empty name applies to all elements.
  std::map<std::string, ElementDefaults, std::less<>> classes_{{"", {}}};
  /// Other names of that class.
  std::set<std::string, std::less<>> names_of_all_{"main"};
};

/// Settings of <compiler>, which affect the meaning of other elements.
struct MjcfSettings {
  bool in_degrees = true;
  std::string euler_sequence = "xyz";
  bool auto_limits = true;
  std::string mesh_folder;
  std::string texture_folder;
  bool strips_paths = false;
  /// Whether masses come from shapes always, never, or only without an <inertial>.
  enum class Inertias { kFromShapes, kStated, kStatedOrFromShapes };
  Inertias inertias = Inertias::kStatedOrFromShapes;
  /// Range of groups whose shapes have mass.
  std::array<double, 2> massive_groups{0, 5};
  /// Kilograms of the whole robot; if absent, the masses stay as they are.
  std::optional<double> total_mass;

  /// Converts an angle of the text to radians.
  [[nodiscard]] double radians(double angle) const;
  /// Reads a <compiler>; its settings replace those of earlier ones.
  void read(const MjcfAttributes& compiler);
};

/// The pose of an element: pos, and quat, axisangle, euler, xyaxes or zaxis.
[[nodiscard]] Affine poseOf(const MjcfAttributes& attributes, const MjcfSettings& settings);

/// A rotation by `angle` (radians) about `axis`, which may have any length except 0.
[[nodiscard]] Affine rotationAbout(const std::array<double, 3>& axis, double angle);
/// The smallest rotation that takes Z to `direction`, which may have any length except 0.
[[nodiscard]] Affine rotationOfZ(const std::array<double, 3>& direction);
/// The rotation of a quaternion w, x, y, z, which may have any length except 0.
[[nodiscard]] Affine rotationOf(const std::array<double, 4>& quaternion);
[[nodiscard]] Affine translationOf(const std::array<double, 3>& offset);

}  // namespace galactic::bake
