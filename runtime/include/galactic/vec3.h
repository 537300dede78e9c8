#pragma once

namespace galactic {

/// A point or direction in the world frame: right-handed, Y up, meters.
struct Vec3 {
  float x = 0;
  float y = 0;
  float z = 0;

  friend bool operator==(const Vec3&, const Vec3&) = default;
};

/// A closed interval of heights, meters; lo <= hi.
struct Span {
  float lo = 0;
  float hi = 0;

  friend bool operator==(const Span&, const Span&) = default;
};

}  // namespace galactic
