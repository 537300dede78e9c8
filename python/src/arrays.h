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

/// The name of a value's Python type, such as "list".
[[nodiscard]] std::string typeName(const py::handle& value);

/// A shape as Python writes it: "(128, 11)".
[[nodiscard]] std::string shapeText(std::span<const py::ssize_t> shape);

/// Memory of `owner` as a read-only array, without a copy. The array holds a reference to the
/// owner, which therefore outlives it; its contents change with the owner's next step. `type` is
/// the element type that Python sees, of the same size as T.
template <class T>
[[nodiscard]] py::array viewOf(std::span<const T> values, Shape shape, py::handle owner,
                               const py::dtype& type = py::dtype::of<T>()) {
  py::array view(type, std::move(shape), values.data(), owner);
  py::detail::array_proxy(view.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return view;
}

/// Numbers from a caller as a contiguous array: the given array if it is one, else a converted
/// copy.
template <class T>
using InputArray = py::array_t<T, py::array::c_style | py::array::forcecast>;

/// The argument `name` as a contiguous array of T: the argument itself if it is one, else a
/// converted copy. Raises ValueError for another shape, and TypeError if it is not an array of
/// numbers, or if the numbers have fractions and T has none.
template <class T>
[[nodiscard]] InputArray<T> inputOf(const py::handle& given, const char* name, const Shape& shape);

/// The same for whole numbers of any type. Nothing is rounded: raises TypeError for other numbers,
/// and IndexError for those that do not fit in a signed 64-bit integer.
[[nodiscard]] InputArray<std::int64_t> wholeNumbersOf(const py::handle& given, const char* name,
                                                      const Shape& shape);

/// The argument `name` as an array of numbers of any shape. Raises TypeError for other types that
/// numpy would convert: it would parse text, and drop the imaginary part of complex numbers.
[[nodiscard]] py::array numbersIn(const py::handle& given, const char* name);

/// `given` as `count` finite numbers. Raises ValueError for another shape or numbers that are not
/// finite, and TypeError for what numbersIn() rejects.
[[nodiscard]] std::vector<float> finiteNumbers(const py::handle& given, const char* name,
                                               std::size_t count);

/// `given` as points, float (n, 3), or an empty list. Raises ValueError for another shape or
/// numbers that are not finite.
[[nodiscard]] std::vector<Vec3> pointsOf(const py::handle& given, const char* name);
/// The same for n points per env: float (envs, n, 3), one env after the other.
[[nodiscard]] std::vector<Vec3> pointsOf(const py::handle& given, const char* name,
                                         py::ssize_t envs);

/// The argument `name` as memory for results: an array of exactly this type and shape, writable and
/// contiguous. Nothing is converted. Raises TypeError or ValueError for anything else.
template <class T>
[[nodiscard]] std::span<T> outputOf(const py::handle& given, const char* name, const Shape& shape);

/// The bytes of a bytes-like object, while this object lives. Raises TypeError for other objects,
/// and BufferError for buffers that are not contiguous.
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

/// Writes a transform as a homogeneous matrix, row-major, 4 x 4.
void writeMatrix(const RigidTransform& a_from_b, float* rows);

/// Truth values from C++, 0 or 1, as a numpy array: bool (n,).
[[nodiscard]] py::array_t<bool> truthsOf(std::span<const std::uint8_t> answers);

/// A new array with a copy of `values`.
[[nodiscard]] py::array_t<float> arrayOf(std::span<const float> values);

}  // namespace galactic::python
