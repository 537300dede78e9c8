#include "dlpack.h"

#include <dlfcn.h>

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "galactic/error.h"

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
  /// Null: rows without gaps.
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

/// What a consumer holds: the tensor, its shape, and who owns the memory.
struct Export {
  DlManagedTensor managed;
  std::vector<std::int64_t> shape;
  py::object owner;
};

void release(DlManagedTensor* managed) {
  // From any thread of the consumer.
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

/// A function of CUDA's driver, which is loaded already when there are device images.
template <class Function>
Function driverFunction(const char* name) {
  void* library = dlopen("libcuda.so.1", RTLD_LAZY | RTLD_LOCAL);
  void* function = library == nullptr ? nullptr : dlsym(library, name);
  if (function != nullptr) return reinterpret_cast<Function>(function);
  throw ErrorException{
      {ErrorCode::kUnsupported, "device images",
       std::string("found no ") + name + " in libcuda.so.1; install NVIDIA's driver"}};
}

int currentDevice() {
  int device = -1;
  if (driverFunction<int (*)(int*)>("cuCtxGetDevice")(&device) == 0) return device;
  throw ErrorException{{ErrorCode::kUnsupported, "device images",
                        "no CUDA context is current on this thread; make one first"}};
}

/// The images are there in the order of the legacy default stream. Streams that do not wait for it
/// by themselves get them when they are complete.
void awaitImagesFor(const py::object& stream) {
  constexpr std::int64_t kLegacyDefault = 1;
  constexpr std::int64_t kThreadDefault = 2;
  constexpr std::int64_t kNoWait = -1;
  const std::int64_t number = stream.is_none() ? kLegacyDefault : stream.cast<std::int64_t>();
  if (number == 0) {
    throw py::buffer_error("stream 0 is ambiguous on CUDA; give 1 or 2 for a default stream");
  }
  if (number == kLegacyDefault || number == kThreadDefault || number == kNoWait) return;
  const auto synchronize = driverFunction<int (*)(void*)>("cuStreamSynchronize");
  const int code = [&] {
    const py::gil_scoped_release unlocked;
    return synchronize(nullptr);
  }();
  if (code == 0) return;
  throw ErrorException{{ErrorCode::kInternal, "device images",
                        "did not become complete: cuStreamSynchronize failed with CUDA's error " +
                            std::to_string(code) + "; what ran on the device before has failed"}};
}

}  // namespace

DeviceArray::DeviceArray(std::uint64_t address, Shape shape, ElementType type, py::object owner)
    : address_(address),
      shape_(std::move(shape)),
      type_(type),
      owner_(std::move(owner)),
      device_(currentDevice()) {}

py::capsule DeviceArray::capsule(const Wish& wish) const {
  if (!wish.device.is_none() && !wish.device.equal(device())) {
    throw py::buffer_error("the images are on their renderer's device; copy them from there");
  }
  if (!wish.copy.is_none() && wish.copy.cast<bool>()) {
    throw py::buffer_error(
        "the images are handed on without a copy; copy them where they are used");
  }
  awaitImagesFor(wish.stream);
  auto held = std::make_unique<Export>();
  held->shape.assign(shape_.begin(), shape_.end());
  held->owner = owner_;
  held->managed.tensor = {.data = reinterpret_cast<void*>(address_),
                          .device = {.id = device_},
                          .axes = static_cast<std::int32_t>(shape_.size()),
                          .type = typeOf(type_),
                          .shape = held->shape.data()};
  held->managed.context = held.get();
  held->managed.deleter = &release;
  DlManagedTensor* managed = &held.release()->managed;
  // A consumer renames the capsule and takes over what it holds; else it goes with the capsule.
  return py::capsule(managed, kCapsuleName, [](PyObject* capsule) {
    if (PyCapsule_IsValid(capsule, kCapsuleName) == 0) return;
    auto* unused = static_cast<DlManagedTensor*>(PyCapsule_GetPointer(capsule, kCapsuleName));
    unused->deleter(unused);
  });
}

py::tuple DeviceArray::device() const { return py::make_tuple(kDlCuda, device_); }

}  // namespace galactic::python
