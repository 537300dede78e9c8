#pragma once
#include <pybind11/pybind11.h>

#include <cstdint>

#include "arrays.h"

namespace galactic::python {

enum class ElementType : std::uint8_t { kUint8, kInt32, kFloat32 };

/// Memory of a CUDA device as Python's array libraries take it over: DLPack (v0.8, the unversioned
/// capsule that all of them know), without a copy. Rows without gaps.
class DeviceArray {
 public:
  struct Place {
    std::uint64_t address = 0;
    /// CUDA's number of the device.
    int device = 0;
  };
  /// What is there must be complete. `owner` stays as long as anybody uses the memory.
  DeviceArray(const Place& place, Shape shape, ElementType type, py::object owner);

  /// What a consumer may ask for, by the array API standard.
  struct Wish {
    /// Where it will use the memory, which is complete for all of them: None and 1 for the legacy
    /// default stream, 2 for that of the thread, -1 for no synchronization, else a cudaStream_t. 0
    /// is forbidden.
    py::object stream;
    /// Another device than this one, and a copy, are not given; None asks for neither.
    py::object device;
    py::object copy;
  };

  /// The capsule "dltensor"; BufferError for a wish that cannot be met.
  [[nodiscard]] py::capsule capsule(const Wish& wish) const;
  /// (kDLCUDA, number of the device).
  [[nodiscard]] py::tuple device() const;

  [[nodiscard]] const Shape& shape() const { return shape_; }
  [[nodiscard]] ElementType type() const { return type_; }

 private:
  Place place_;
  Shape shape_;
  ElementType type_;
  py::object owner_;
};

}  // namespace galactic::python
