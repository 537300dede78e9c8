#include "render/cuda/driver.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "render/cuda_symbols.h"
#include "render/device_wish.h"
#include "support/try.h"

namespace galactic::render::cuda {
namespace {

constexpr const char* kWhere = "render backend cuda";
/// Attributes of devices, as cuda.h numbers them.
constexpr int kMultiprocessors = 16;
constexpr int kCapabilityMajor = 75;
constexpr int kCapabilityMinor = 76;
/// The kernels' instructions need this compute capability.
constexpr int kLeastMajor = 7;

tl::unexpected<Error> refuse(std::string message) {
  return fail(ErrorCode::kUnsupported, kWhere, std::move(message));
}

const char* findAll(void* library, DriverFunctions& functions) {
  CudaSymbols symbols(library);
  symbols.find("cuInit", functions.init);
  symbols.find("cuGetErrorName", functions.error_name);
  symbols.find("cuDeviceGetCount", functions.device_count);
  symbols.find("cuDeviceGet", functions.device);
  symbols.find("cuDeviceGetName", functions.device_name);
  symbols.find("cuDeviceGetUuid", functions.device_uuid);
  symbols.find("cuDeviceGetAttribute", functions.device_attribute);
  symbols.find("cuDevicePrimaryCtxRetain", functions.retain_context);
  symbols.find("cuDevicePrimaryCtxRelease_v2", functions.release_context);
  symbols.find("cuCtxPushCurrent_v2", functions.push_context);
  symbols.find("cuCtxPopCurrent_v2", functions.pop_context);
  symbols.find("cuModuleLoadDataEx", functions.load_module);
  symbols.find("cuModuleUnload", functions.unload_module);
  symbols.find("cuModuleGetFunction", functions.function);
  symbols.find("cuMemAlloc_v2", functions.allocate);
  symbols.find("cuMemFree_v2", functions.free);
  symbols.find("cuMemHostAlloc", functions.allocate_host);
  symbols.find("cuMemFreeHost", functions.free_host);
  symbols.find("cuMemcpyHtoDAsync_v2", functions.copy_to_device);
  symbols.find("cuMemcpyDtoHAsync_v2", functions.copy_to_host);
  symbols.find("cuMemsetD32Async", functions.set_words);
  symbols.find("cuLaunchKernel", functions.launch);
  symbols.find("cuStreamSynchronize", functions.synchronize);
  return symbols.missing();
}

/// The number of the device with this UUID.
Result<int> deviceWithUuid(const Driver& driver, const DeviceUuid& wanted) {
  const DriverFunctions& functions = driver.functions();
  for (int number = 0; number < driver.deviceCount(); ++number) {
    int device = 0;
    DeviceUuid uuid{};
    if (functions.device(&device, number) == 0 && functions.device_uuid(uuid.data(), device) == 0 &&
        uuid == wanted) {
      return number;
    }
  }
  return refuse(
      fmt::format("none of CUDA's {} devices has the UUID that was asked for; "
                  "\"nvidia-smi -L\" lists them, and CUDA_VISIBLE_DEVICES may hide some",
                  driver.deviceCount()));
}

Result<int> wishedDevice(const Driver& driver, const std::string& text) {
  ASSIGN_OR_RETURN(const DeviceWish wish, parseDeviceWish(text));
  switch (wish.kind) {
    case DeviceWish::Kind::kFirstGpu:
      return 0;
    case DeviceWish::Kind::kUuid:
      return deviceWithUuid(driver, wish.uuid);
    case DeviceWish::Kind::kSoftware:
      return refuse("the cuda backend has no software driver; ask for the soft backend");
    case DeviceWish::Kind::kIndex:
    case DeviceWish::Kind::kCuda:
      break;
  }
  if (wish.number < static_cast<std::uint32_t>(driver.deviceCount())) {
    return static_cast<int>(wish.number);
  }
  return refuse(
      fmt::format("found device {} asked for, but CUDA has {} (0 to {}); "
                  "CUDA_VISIBLE_DEVICES may hide some",
                  wish.number, driver.deviceCount(), driver.deviceCount() - 1));
}

}  // namespace

Result<std::unique_ptr<Driver>> Driver::open(const std::string& library) {
  void* opened = dlopen(library.c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (opened == nullptr) {
    return refuse(
        fmt::format("found no {}; install NVIDIA's driver, or use the soft backend", library));
  }
  auto driver = std::make_unique<Driver>();
  if (const char* missing = findAll(opened, driver->functions_)) {
    return refuse(fmt::format("{} is too old: it has no {}", library, missing));
  }
  // CUDA_ERROR_NO_DEVICE.
  constexpr int kNoDevice = 100;
  const int started = driver->functions_.init(0);
  if (started != kNoDevice) {
    RETURN_IF_ERROR(driver->check(started, "start"));
    RETURN_IF_ERROR(
        driver->check(driver->functions_.device_count(&driver->device_count_), "count devices"));
  }
  if (driver->device_count_ == 0) {
    return refuse("CUDA's driver finds no device; CUDA_VISIBLE_DEVICES may hide those there are");
  }
  return driver;
}

Error Driver::failure(int error, const std::string& what) const {
  const char* name = nullptr;
  functions_.error_name(error, &name);
  return {ErrorCode::kUnsupported, kWhere,
          fmt::format("CUDA's driver could not {}: error {} ({})", what, error,
                      name == nullptr ? "unknown" : name)};
}

Result<void> Driver::check(int error, const char* what) const {
  if (error == 0) return {};
  return tl::unexpected<Error>(failure(error, what));
}

Result<Device> Device::choose(const Driver& driver, const std::string& wish) {
  ASSIGN_OR_RETURN(const int number, wishedDevice(driver, wish));
  const DriverFunctions& functions = driver.functions();
  Device chosen(driver);
  std::array<char, 256> name{};
  int device = 0;
  RETURN_IF_ERROR(driver.check(functions.device(&device, number), "find the device"));
  RETURN_IF_ERROR(driver.check(
      functions.device_name(name.data(), static_cast<int>(name.size()) - 1, device), "name it"));
  const auto ask = [&](int attribute, int& value) {
    return driver.check(functions.device_attribute(&value, attribute, device), "describe it");
  };
  RETURN_IF_ERROR(ask(kMultiprocessors, chosen.multiprocessors_));
  RETURN_IF_ERROR(ask(kCapabilityMajor, chosen.major_));
  RETURN_IF_ERROR(ask(kCapabilityMinor, chosen.minor_));
  chosen.name_ = name.data();
  if (chosen.major_ < kLeastMajor) {
    return refuse(fmt::format("{} has compute capability {}.{}; expected {}.0 or more",
                              chosen.name_, chosen.major_, chosen.minor_, kLeastMajor));
  }
  chosen.number_ = number;
  chosen.device_ = device;
  return chosen;
}

Result<void> Device::open() {
  return driver_->check(driver_->functions().retain_context(&context_, device_), "make a context");
}

Device::Device(Device&& other) noexcept
    : driver_(other.driver_),
      number_(other.number_),
      device_(other.device_),
      context_(std::exchange(other.context_, nullptr)),
      name_(std::move(other.name_)),
      major_(other.major_),
      minor_(other.minor_),
      multiprocessors_(other.multiprocessors_) {}

Device::~Device() {
  if (context_ != nullptr) driver_->functions().release_context(device_);
}

Memory::Memory(Memory&& other) noexcept
    : driver_(other.driver_),
      kind_(other.kind_),
      address_(std::exchange(other.address_, 0)),
      host_(std::exchange(other.host_, nullptr)),
      size_(std::exchange(other.size_, 0)) {}

Result<void> Memory::reserve(std::size_t bytes) {
  if (bytes <= size_) return {};
  free();
  const DriverFunctions& functions = driver_->functions();
  if (kind_ == Kind::kDevice) {
    const int error = functions.allocate(&address_, bytes);
    if (error != 0) {
      return tl::unexpected<Error>(
          driver_->failure(error, fmt::format("reserve {} MB on the device", (bytes >> 20U) + 1)));
    }
  } else {
    void* memory = nullptr;
    RETURN_IF_ERROR(
        driver_->check(functions.allocate_host(&memory, bytes, 0), "reserve pinned memory"));
    host_ = static_cast<std::byte*>(memory);
  }
  size_ = bytes;
  return {};
}

void Memory::free() {
  if (size_ == 0) return;
  if (kind_ == Kind::kDevice) {
    driver_->functions().free(address_);
  } else {
    driver_->functions().free_host(host_);
  }
  address_ = 0;
  host_ = nullptr;
  size_ = 0;
}

}  // namespace galactic::render::cuda
