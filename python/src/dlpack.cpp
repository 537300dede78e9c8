#include "dlpack.h"

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace galactic::python {
namespace {

// The layout of dlpack.h, version 0.8, which is an ABI: https://github.com/dmlc/dlpack.
constexpr std::int32_t kDlCuda = 2;

struct DlDevice {
  std::int32_t type = kDlCuda;
  std::int32_t id = 0;
};

struct DlType {
  std::uint8_t code = 0;
  std::uint8_t bits = 0;
  std::uint16_t lanes = 1;
};

struct DlTensor {
  void* data = nullptr;
  DlDevice device;
  std::int32_t axes = 0;
  DlType type;
  std::int64_t* shape = nullptr;
  /// Null: contiguous.
  std::int64_t* strides = nullptr;
  std::uint64_t byte_offset = 0;
};

struct DlManagedTensor {
  DlTensor tensor;
  void* context = nullptr;
  void (*deleter)(DlManagedTensor*) = nullptr;
};
static_assert(sizeof(DlManagedTensor) == 64 && offsetof(DlTensor, shape) == 24);

constexpr const char* kCapsuleName = "dltensor";

/// What a consumer holds: the tensor, its shape, and the owner of the memory.
struct Export {
  DlManagedTensor managed;
  std::vector<std::int64_t> shape;
  py::object owner;
};

void release(DlManagedTensor* managed) {
  // May be called from any thread of the consumer.
  const py::gil_scoped_acquire locked;
  delete static_cast<Export*>(managed->context);
}

DlType typeOf(ElementType type) {
  constexpr std::uint8_t kSigned = 0;
  constexpr std::uint8_t kUnsigned = 1;
  constexpr std::uint8_t kFloat = 2;
  if (type == ElementType::kFloat32) return {.code = kFloat, .bits = 32};
  if (type == ElementType::kInt32) return {.code = kSigned, .bits = 32};
  return {.code = kUnsigned, .bits = 8};
}

/// Images are complete before they become a DeviceArray, so no stream has to wait for them.
void requireStream(const py::object& stream) {
  if (stream.is_none() || stream.cast<std::int64_t>() != 0) return;
  throw py::buffer_error("stream 0 is ambiguous on CUDA; give 1 or 2 for a default stream");
}

}  // namespace

DeviceArray::DeviceArray(const Place& place, Shape shape, ElementType type, py::object owner)
    : place_(place), shape_(std::move(shape)), type_(type), owner_(std::move(owner)) {}

py::capsule DeviceArray::capsule(const Wish& wish) const {
  if (!wish.device.is_none() && !wish.device.equal(device())) {
    throw py::buffer_error("the images are on their renderer's device; copy them from there");
  }
  if (!wish.copy.is_none() && wish.copy.cast<bool>()) {
    throw py::buffer_error(
        "the images are handed on without a copy; copy them where they are used");
  }
  requireStream(wish.stream);
  auto held = std::make_unique<Export>();
  held->shape.assign(shape_.begin(), shape_.end());
  held->owner = owner_;
  held->managed.tensor = {.data = reinterpret_cast<void*>(place_.address),
                          .device = {.id = place_.device},
                          .axes = static_cast<std::int32_t>(shape_.size()),
                          .type = typeOf(type_),
                          .shape = held->shape.data()};
  held->managed.context = held.get();
  held->managed.deleter = &release;
  DlManagedTensor* managed = &held.release()->managed;
  // A consumer renames the capsule and takes over its contents; otherwise they are freed with the
  // capsule.
  return py::capsule(managed, kCapsuleName, [](PyObject* capsule) {
    if (PyCapsule_IsValid(capsule, kCapsuleName) == 0) return;
    auto* unused = static_cast<DlManagedTensor*>(PyCapsule_GetPointer(capsule, kCapsuleName));
    unused->deleter(unused);
  });
}

py::tuple DeviceArray::device() const { return py::make_tuple(kDlCuda, place_.device); }

}  // namespace galactic::python
