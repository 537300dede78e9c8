#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <array>
#include <span>

#include "arrays.h"
#include "galactic/pose.h"

namespace galactic::python {

inline std::array<float, 3> numbersOf(const Vec3& v) { return {v.x, v.y, v.z}; }
inline std::array<float, 4> numbersOf(const Quat& q) { return {q.w, q.x, q.y, q.z}; }

/// An array that is filled from its first element on.
template <class T>
class Filled {
 public:
  explicit Filled(const Shape& shape) : array_(shape), next_(array_.mutable_data()) {}

  void put(T value) { *next_++ = value; }
  void put(std::span<const T> values) { next_ = std::ranges::copy(values, next_).out; }
  [[nodiscard]] const py::array_t<T>& array() const { return array_; }

 private:
  py::array_t<T> array_;
  T* next_;
};

/// galactic.Poses of a given shape, filled from the first pose on.
class FilledPoses {
 public:
  explicit FilledPoses(const Shape& shape)
      : translation_(with(shape, 3)), rotation_(with(shape, 4)) {}

  void put(const Pose& pose) {
    translation_.put(numbersOf(pose.translation));
    rotation_.put(numbersOf(pose.rotation));
  }
  [[nodiscard]] py::object poses(const py::module_& types) const {
    return types.attr("Poses")(translation_.array(), rotation_.array());
  }

 private:
  static Shape with(Shape shape, py::ssize_t last) {
    shape.push_back(last);
    return shape;
  }

  Filled<float> translation_;
  Filled<float> rotation_;
};

}  // namespace galactic::python
