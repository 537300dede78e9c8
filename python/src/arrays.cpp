#include "arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <type_traits>

namespace galactic::python {
namespace {

std::span<const py::ssize_t> shapeOf(const py::array& array) {
  return {array.shape(), static_cast<std::size_t>(array.ndim())};
}

void requireShape(const py::array& array, const char* name, const Shape& wanted) {
  if (std::ranges::equal(shapeOf(array), wanted)) return;
  throw py::value_error(fmt::format("{} has the shape {}, expected {}", name,
                                    shapeText(shapeOf(array)), shapeText(wanted)));
}

std::string typeText(const py::handle& type) { return py::str(type).cast<std::string>(); }

[[noreturn]] void refuseNumbers(const char* name, const std::string& found) {
  throw py::type_error(fmt::format("{} is {}, expected an array of whole numbers", name, found));
}

/// Throws for an array whose numbers a conversion to integers would truncate. An empty list is
/// fine, though numpy makes it an array of floats.
void requireNoFractions(const py::handle& given, const char* name) {
  const py::array array = py::array::ensure(given);
  if (!array) return PyErr_Clear();
  const char kind = array.dtype().kind();
  if (array.size() > 0 && (kind == 'f' || kind == 'c'))
    refuseNumbers(name, typeText(array.dtype()) + " numbers");
}

bool areFinite(std::span<const float> numbers) {
  return std::ranges::all_of(numbers, [](float one) { return std::isfinite(one); });
}

constexpr py::ssize_t kNumbersOfAPoint = 3;

std::string shapeFound(const py::array& array) {
  return array ? "the shape " + shapeText(shapeOf(array)) : "no shape";
}

/// `shaped`: (n, 3) or (envs, n, 3).
std::vector<Vec3> pointsIn(const py::array& shaped, const char* name) {
  const std::span<const py::ssize_t> shape = shapeOf(shaped);
  const auto array =
      inputOf<float>(numbersIn(shaped, name), name, Shape(shape.begin(), shape.end()));
  const float* numbers = array.data();
  const py::ssize_t count = array.size() / kNumbersOfAPoint;
  std::vector<Vec3> points;
  points.reserve(static_cast<std::size_t>(count));
  for (py::ssize_t n = 0; n < count; ++n, numbers += kNumbersOfAPoint) {
    if (!areFinite({numbers, kNumbersOfAPoint})) {
      const py::ssize_t each = shape[shape.size() - 2];
      const std::string env = shape.size() == 2 ? "" : fmt::format("{}, ", n / each);
      throw py::value_error(
          fmt::format("{}[{}{}] holds a number that is not finite", name, env, n % each));
    }
    points.push_back({numbers[0], numbers[1], numbers[2]});
  }
  return points;
}

}  // namespace

std::string typeName(const py::handle& value) {
  return typeText(py::type::of(value).attr("__name__"));
}

std::string shapeText(std::span<const py::ssize_t> shape) {
  std::string text = "(";
  for (std::size_t n = 0; n < shape.size(); ++n) {
    text += fmt::format("{}{}", n == 0 ? "" : ", ", shape[n]);
  }
  return text + (shape.size() == 1 ? ",)" : ")");
}

template <class T>
InputArray<T> inputOf(const py::handle& given, const char* name, const Shape& shape) {
  if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) requireNoFractions(given, name);
  auto array = InputArray<T>::ensure(given);
  if (!array) {
    PyErr_Clear();
    throw py::type_error(
        fmt::format("{} is a {}, expected an array of numbers", name, typeName(given)));
  }
  requireShape(array, name, shape);
  return array;
}

InputArray<std::int64_t> wholeNumbersOf(const py::handle& given, const char* name,
                                        const Shape& shape) {
  const py::array array = py::array::ensure(given);
  if (!array) PyErr_Clear();
  const char kind = array ? array.dtype().kind() : '?';
  const bool is_empty = array && array.size() == 0;
  if (kind != 'i' && kind != 'u' && !is_empty) {
    refuseNumbers(name, array ? typeText(array.dtype()) + " numbers" : "a " + typeName(given));
  }
  auto numbers = inputOf<std::int64_t>(array, name, shape);
  if (kind == 'u' && array.itemsize() == sizeof(std::int64_t)) {
    // A negative number here means that an unsigned one did not fit.
    const std::span values(numbers.data(), static_cast<std::size_t>(numbers.size()));
    const auto wrong = std::ranges::find_if(values, [](std::int64_t one) { return one < 0; });
    if (wrong != values.end()) {
      throw py::index_error(fmt::format("{} has {}, expected at most {}", name,
                                        static_cast<std::uint64_t>(*wrong),
                                        std::numeric_limits<std::int64_t>::max()));
    }
  }
  return numbers;
}

py::array numbersIn(const py::handle& given, const char* name) {
  py::array array = py::array::ensure(given);
  if (!array) {
    PyErr_Clear();
    throw py::type_error(
        fmt::format("{} is a {}, expected an array of numbers", name, typeName(given)));
  }
  if (std::string_view("biuf").find(array.dtype().kind()) == std::string_view::npos) {
    throw py::type_error(
        fmt::format("{} has the type {}, expected numbers", name, typeText(array.dtype())));
  }
  return array;
}

std::vector<float> finiteNumbers(const py::handle& given, const char* name, std::size_t count) {
  // Planners call this millions of times: skip the check for arrays of the right type.
  if (!py::isinstance<py::array_t<float>>(given)) static_cast<void>(numbersIn(given, name));
  const auto array = inputOf<float>(given, name, {static_cast<py::ssize_t>(count)});
  std::vector<float> numbers(array.data(), array.data() + count);
  if (!areFinite(numbers)) {
    throw py::value_error(fmt::format("{} holds a number that is not finite", name));
  }
  return numbers;
}

std::vector<Vec3> pointsOf(const py::handle& given, const char* name) {
  const py::array shaped = py::array::ensure(given);
  if (!shaped) PyErr_Clear();
  if (shaped && shaped.ndim() == 1 && shaped.size() == 0) return {};
  if (!shaped || shaped.ndim() != 2 || shaped.shape(1) != kNumbersOfAPoint) {
    throw py::value_error(fmt::format("{} has {}, expected (n, 3)", name, shapeFound(shaped)));
  }
  return pointsIn(shaped, name);
}

std::vector<Vec3> pointsOf(const py::handle& given, const char* name, py::ssize_t envs) {
  const py::array shaped = py::array::ensure(given);
  if (!shaped) PyErr_Clear();
  if (!shaped || shaped.ndim() != 3 || shaped.shape(0) != envs ||
      shaped.shape(2) != kNumbersOfAPoint) {
    throw py::value_error(
        fmt::format("{} has {}, expected ({}, n, 3)", name, shapeFound(shaped), envs));
  }
  return pointsIn(shaped, name);
}

template <class T>
std::span<T> outputOf(const py::handle& given, const char* name, const Shape& shape) {
  if (!py::isinstance<py::array>(given)) {
    throw py::type_error(
        fmt::format("{} is a {}, expected a numpy array to write to", name, typeName(given)));
  }
  auto array = py::reinterpret_borrow<py::array>(given);
  if (!py::isinstance<py::array_t<T>>(given)) {
    throw py::type_error(fmt::format("{} has the type {}, expected {}", name,
                                     typeText(array.dtype()), typeText(py::dtype::of<T>())));
  }
  requireShape(array, name, shape);
  const bool has_gaps = (array.flags() & py::array::c_style) == 0;
  if (has_gaps || !array.writeable()) {
    throw py::value_error(fmt::format("{} is {}; results are written in place", name,
                                      has_gaps ? "not contiguous" : "read-only"));
  }
  return {static_cast<T*>(array.mutable_data()), static_cast<std::size_t>(array.size())};
}

InputBytes::InputBytes(const py::handle& given) {
  if (PyObject_GetBuffer(given.ptr(), &view_, PyBUF_SIMPLE) != 0) throw py::error_already_set();
}

void writeMatrix(const RigidTransform& a_from_b, float* rows) {
  const auto& [x, y, z, t] = a_from_b;
  const std::array matrix{x.x,  y.x,  z.x,  t.x,  //
                          x.y,  y.y,  z.y,  t.y,  //
                          x.z,  y.z,  z.z,  t.z,  //
                          0.0F, 0.0F, 0.0F, 1.0F};
  std::ranges::copy(matrix, rows);
}

py::array_t<bool> truthsOf(std::span<const std::uint8_t> answers) {
  py::array_t<bool> array(static_cast<py::ssize_t>(answers.size()));
  std::ranges::transform(answers, array.mutable_data(), [](std::uint8_t one) { return one != 0; });
  return array;
}

py::array_t<float> arrayOf(std::span<const float> values) {
  return py::array_t<float>(static_cast<py::ssize_t>(values.size()), values.data());
}

template InputArray<bool> inputOf<bool>(const py::handle&, const char*, const Shape&);
template InputArray<std::int64_t> inputOf<std::int64_t>(const py::handle&, const char*,
                                                        const Shape&);
template InputArray<double> inputOf<double>(const py::handle&, const char*, const Shape&);
template InputArray<float> inputOf<float>(const py::handle&, const char*, const Shape&);
template InputArray<std::uint8_t> inputOf<std::uint8_t>(const py::handle&, const char*,
                                                        const Shape&);
template std::span<float> outputOf<float>(const py::handle&, const char*, const Shape&);
template std::span<std::uint8_t> outputOf<std::uint8_t>(const py::handle&, const char*,
                                                        const Shape&);
template std::span<std::int32_t> outputOf<std::int32_t>(const py::handle&, const char*,
                                                        const Shape&);

}  // namespace galactic::python
