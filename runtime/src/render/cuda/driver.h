#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "galactic/error.h"
#include "render/cuda_symbols.h"

namespace galactic::render::cuda {

/// Addresses of memory on a device.
using DeviceAddress = std::uint64_t;

/// The functions of CUDA's driver that are used; see CudaSymbols.
struct DriverFunctions {
  int (*init)(unsigned flags) = nullptr;
  int (*error_name)(int error, const char** name) = nullptr;
  int (*device_count)(int* count) = nullptr;
  int (*device)(int* device, int number) = nullptr;
  int (*device_name)(char* name, int length, int device) = nullptr;
  int (*device_uuid)(unsigned char* uuid, int device) = nullptr;
  int (*device_attribute)(int* value, int attribute, int device) = nullptr;
  int (*retain_context)(void** context, int device) = nullptr;
  int (*release_context)(int device) = nullptr;
  int (*push_context)(void* context) = nullptr;
  int (*pop_context)(void** context) = nullptr;
  int (*load_module)(void** module, const void* image, unsigned count, int* options,
                     void** values) = nullptr;
  int (*unload_module)(void* module) = nullptr;
  int (*function)(void** function, void* module, const char* name) = nullptr;
  int (*allocate)(DeviceAddress* address, std::size_t bytes) = nullptr;
  int (*free)(DeviceAddress address) = nullptr;
  int (*allocate_host)(void** address, std::size_t bytes, unsigned flags) = nullptr;
  int (*free_host)(void* address) = nullptr;
  int (*copy_to_device)(DeviceAddress to, const void* from, std::size_t bytes,
                        void* stream) = nullptr;
  int (*copy_to_host)(void* to, DeviceAddress from, std::size_t bytes, void* stream) = nullptr;
  int (*set_words)(DeviceAddress to, unsigned value, std::size_t words, void* stream) = nullptr;
  int (*launch)(void* function, unsigned grid_x, unsigned grid_y, unsigned grid_z, unsigned block_x,
                unsigned block_y, unsigned block_z, unsigned shared_bytes, void* stream,
                void** parameters, void** extra) = nullptr;
  int (*synchronize)(void* stream) = nullptr;
};

/// CUDA's driver, opened when it is first needed: the program neither links it nor needs it.
class Driver {
 public:
  /// Fails with kUnsupported if there is no driver, if it is too old, or if it finds no device.
  /// `library`: a path, or a name that the system's loader finds.
  [[nodiscard]] static Result<std::unique_ptr<Driver>> open(
      const std::string& library = kCudaLibrary);

  [[nodiscard]] const DriverFunctions& functions() const { return functions_; }
  [[nodiscard]] int deviceCount() const { return device_count_; }
  /// The error for a call that tried to do `what` and returned `error`, which is not 0.
  [[nodiscard]] Error failure(int error, const std::string& what) const;
  /// Success if `error` is 0, otherwise failure(error, what).
  [[nodiscard]] Result<void> check(int error, const char* what) const;

 private:
  DriverFunctions functions_;
  int device_count_ = 0;
};

/// A device. After open(), this keeps the device's context alive, the one that CUDA's runtime and
/// the learning libraries also use.
class Device {
 public:
  /// `wish`: see RenderOptions::device; nothing, a number, "cuda:N" or a UUID. Numbers are CUDA's
  /// own, so CUDA_VISIBLE_DEVICES applies. Fails with kUnsupported if there is no such device, and
  /// with kInvalidInput if the text is anything else.
  [[nodiscard]] static Result<Device> choose(const Driver& driver, const std::string& wish);
  Device(Device&& other) noexcept;
  Device& operator=(Device&&) = delete;
  ~Device();

  /// Fails with kUnsupported if the driver refuses.
  [[nodiscard]] Result<void> open();
  /// Whether the chip is made for data centers. Such chips have few units that draw triangles, and
  /// their compute capabilities end in 0 (V100, A100, H100, B200).
  [[nodiscard]] bool isForDataCenters() const { return minor_ == 0; }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] int major() const { return major_; }
  [[nodiscard]] int minor() const { return minor_; }
  [[nodiscard]] int multiprocessors() const { return multiprocessors_; }
  [[nodiscard]] void* context() const { return context_; }
  /// CUDA's own number, which learning libraries use too.
  [[nodiscard]] int number() const { return number_; }

 private:
  explicit Device(const Driver& driver) : driver_(&driver) {}

  const Driver* driver_;
  int number_ = 0;
  int device_ = 0;
  void* context_ = nullptr;
  std::string name_;
  int major_ = 0;
  int minor_ = 0;
  int multiprocessors_ = 0;
};

/// Makes a device's context current on this thread for a scope, then restores the one that was
/// current before. If the driver refuses, that one stays current and must be left alone.
class CurrentDevice {
 public:
  CurrentDevice(const Driver& driver, const Device& device)
      : driver_(driver), error_(driver.functions().push_context(device.context())) {}
  ~CurrentDevice() {
    if (!holds()) return;
    void* context = nullptr;
    driver_.functions().pop_context(&context);
  }
  /// Whether the context is current.
  [[nodiscard]] bool holds() const { return error_ == 0; }
  /// The driver's error if it is not.
  [[nodiscard]] Error failure() const {
    return driver_.failure(error_, "make the renderer's context current");
  }
  CurrentDevice(const CurrentDevice&) = delete;
  CurrentDevice& operator=(const CurrentDevice&) = delete;

 private:
  const Driver& driver_;
  int error_;
};

/// Memory of the device, or memory of the processor that the device reads. The device's context
/// must be current during all calls, including the destructor's.
class Memory {
 public:
  enum class Kind : std::uint8_t { kDevice, kHost };
  Memory(const Driver& driver, Kind kind) : driver_(&driver), kind_(kind) {}
  ~Memory() { free(); }
  Memory(Memory&& other) noexcept;
  Memory& operator=(Memory&&) = delete;

  /// Makes room for `bytes` bytes. If the memory grows, it loses its content.
  [[nodiscard]] Result<void> reserve(std::size_t bytes);
  [[nodiscard]] DeviceAddress address() const { return address_; }
  /// Only for Kind::kHost.
  [[nodiscard]] std::byte* bytes() const { return host_; }
  [[nodiscard]] std::size_t size() const { return size_; }

  /// Frees the memory.
  void free();

 private:
  const Driver* driver_;
  Kind kind_;
  DeviceAddress address_ = 0;
  std::byte* host_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace galactic::render::cuda
