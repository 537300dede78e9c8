#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/error.h"

namespace galactic::render {

/// Identifies a graphics processor across programs and drivers.
using DeviceUuid = std::array<std::uint8_t, 16>;

/// What RenderOptions::device asks for.
struct DeviceWish {
  enum class Kind : std::uint8_t { kFirstGpu, kIndex, kCuda, kUuid, kSoftware };
  Kind kind = Kind::kFirstGpu;
  /// For kIndex and kCuda.
  std::uint32_t number = 0;
  /// For kUuid.
  DeviceUuid uuid{};
};

/// What EGL tells of a device before anything is opened on it.
struct DeviceFacts {
  /// Its node in the file system, or another name for messages.
  std::string name;
  bool software = false;
  /// Number that CUDA has for it.
  std::optional<std::int64_t> cuda;
};

/// What an opened OpenGL context tells of itself.
struct ContextFacts {
  int major = 0;
  int minor = 0;
  /// The driver's renderer string.
  std::string renderer;
  std::optional<DeviceUuid> uuid;
};

/// Reads RenderOptions::device: an index, "cuda:N", a UUID (32 hexadecimal digits, with or without
/// dashes and a leading "GPU-"), "software", or nothing. Fails with kInvalidInput on other text.
[[nodiscard]] Result<DeviceWish> parseDeviceWish(std::string_view text);

/// The numbers of the devices to try for a wish, best first. Fails with kUnsupported when no device
/// can be the right one. Those that CUDA knows stand before others; a software driver is only ever
/// tried when it is asked for.
[[nodiscard]] Result<std::vector<std::size_t>> devicesFor(const DeviceWish& wish,
                                                          std::span<const DeviceFacts> devices);

/// Whether the renderer string is that of a driver which draws on the processor.
[[nodiscard]] bool isSoftwareRenderer(std::string_view renderer);

/// Whether an opened context is what was wished for: OpenGL 4.5, a graphics processor unless
/// software was asked for, the right UUID. Fails with kUnsupported, and says what was found.
[[nodiscard]] Result<void> judgeContext(const DeviceWish& wish, const ContextFacts& context);

/// The error for a machine with nothing but a software driver, whose renderer string is `name`.
[[nodiscard]] Error onlySoftware(std::string_view name);

}  // namespace galactic::render
