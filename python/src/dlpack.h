#pragma once
#include <pybind11/pybind11.h>

#include <cstdint>

#include "arrays.h"

namespace galactic::python {

enum class ElementType : std::uint8_t { kUint8, kInt32, kFloat32 };

/// Memory of a CUDA device in the form that Python's array libraries import without a copy: DLPack
/// (v0.8, the unversioned capsule that all of them support). Contiguous.
class DeviceArray {
 public:
  struct Place {
    std::uint64_t address = 0;
    /// CUDA's index of the device.
    int device = 0;
  };
  /// The contents must be complete. `owner` is kept alive while anyone uses the memory.
  DeviceArray(const Place& place, Shape shape, ElementType type, py::object owner);

  /// What a consumer may request, by the array API standard.
  struct Wish {
    /// The stream on which the consumer will use the memory: None and 1 for the legacy default
    /// stream, 2 for the per-thread one, -1 for no synchronization, else a cudaStream_t; 0 is
    /// forbidden. The contents are complete for every stream.
    py::object stream;
    /// A different device or a copy cannot be had; None requests neither.
    py::object device;
    py::object copy;
  };

  /// The capsule "dltensor". Raises BufferError for a request that cannot be met.
  [[nodiscard]] py::capsule capsule(const Wish& wish) const;
  /// (kDLCUDA, index of the device).
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
