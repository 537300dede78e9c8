#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "galactic/pose.h"

namespace galactic::python {

namespace py = pybind11;

/// Sizes along the axes.
using Shape = std::vector<py::ssize_t>;

/// Of a value: "list".
[[nodiscard]] std::string typeName(const py::handle& value);

/// "(128, 11)", as Python writes it.
[[nodiscard]] std::string shapeText(std::span<const py::ssize_t> shape);

/// Memory of `owner` as a read-only array: no copy. The array holds a reference to the owner, which
/// therefore outlives it; what it shows changes with the owner's next step. `type` is the one that
/// Python sees, as large as T.
template <class T>
[[nodiscard]] py::array viewOf(std::span<const T> values, Shape shape, py::handle owner,
                               const py::dtype& type = py::dtype::of<T>()) {
  py::array view(type, std::move(shape), values.data(), owner);
  py::detail::array_proxy(view.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return view;
}

/// Numbers of a caller in rows without gaps: his array where it is one, else a converted copy.
template <class T>
using InputArray = py::array_t<T, py::array::c_style | py::array::forcecast>;

/// What a caller gives as `name`, as an array of T in rows without gaps: itself where it is one,
/// else a converted copy. ValueError when it has another shape, TypeError when it is no array of
/// numbers, or when they have fractions and T has none.
template <class T>
[[nodiscard]] InputArray<T> inputOf(const py::handle& given, const char* name, const Shape& shape);

/// The same for whole numbers of any type, which are not rounded: TypeError for others, and
/// IndexError for what 64 bits with a sign do not hold.
[[nodiscard]] InputArray<std::int64_t> wholeNumbersOf(const py::handle& given, const char* name,
                                                      const Shape& shape);

/// What a caller gives as `name`, as an array of numbers of any shape. TypeError for others, whom
/// numpy would turn into numbers: text by reading it, complex ones by leaving out a part.
[[nodiscard]] py::array numbersIn(const py::handle& given, const char* name);

/// `given` as `count` finite numbers. ValueError for another shape or numbers that are not finite,
/// TypeError for what numbersIn() refuses.
[[nodiscard]] std::vector<float> finiteNumbers(const py::handle& given, const char* name,
                                               std::size_t count);

/// `given` as points, float (n, 3), or an empty list; ValueError for another shape or numbers that
/// are not finite.
[[nodiscard]] std::vector<Vec3> pointsOf(const py::handle& given, const char* name);
/// The same of as many points for each of `envs`: float (envs, n, 3), env after env.
[[nodiscard]] std::vector<Vec3> pointsOf(const py::handle& given, const char* name,
                                         py::ssize_t envs);

/// Memory of the caller, as `name`, that results are written to: an array of exactly this type and
/// shape, writable and in rows without gaps; nothing is converted. TypeError or ValueError when it
/// is another.
template <class T>
[[nodiscard]] std::span<T> outputOf(const py::handle& given, const char* name, const Shape& shape);

/// The bytes of a bytes-like object, for as long as this lives. TypeError for others, BufferError
/// for those with gaps.
class InputBytes {
 public:
  explicit InputBytes(const py::handle& given);
  ~InputBytes() { PyBuffer_Release(&view_); }
  InputBytes(const InputBytes&) = delete;
  InputBytes& operator=(const InputBytes&) = delete;
  InputBytes(InputBytes&&) = delete;
  InputBytes& operator=(InputBytes&&) = delete;

  [[nodiscard]] std::span<const std::byte> bytes() const {
    return {static_cast<const std::byte*>(view_.buf), static_cast<std::size_t>(view_.len)};
  }

 private:
  Py_buffer view_{};
};

/// Writes a transform of homogeneous coordinates, four rows of four.
void writeMatrix(const RigidTransform& a_from_b, float* rows);

/// Answers of C++, 0 or 1, as numpy's truth values: bool (n,).
[[nodiscard]] py::array_t<bool> truthsOf(std::span<const std::uint8_t> answers);

/// Three or four numbers as an array of its own.
[[nodiscard]] py::array_t<float> arrayOf(std::span<const float> values);

}  // namespace galactic::python
