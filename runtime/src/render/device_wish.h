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

/// What EGL reports about a device before anything is opened on it.
struct DeviceFacts {
  /// Its node in the file system, or another name for messages.
  std::string name;
  bool software = false;
  /// CUDA's number of the device.
  std::optional<std::int64_t> cuda;
};

/// What an opened OpenGL context reports about itself.
struct ContextFacts {
  int major = 0;
  int minor = 0;
  /// The driver's renderer string.
  std::string renderer;
  std::optional<DeviceUuid> uuid;
};

/// Reads RenderOptions::device: an index, "cuda:N", a UUID (32 hexadecimal digits, with or without
/// dashes and a leading "GPU-"), "software", or nothing. Fails with kInvalidInput if the text is
/// anything else.
[[nodiscard]] Result<DeviceWish> parseDeviceWish(std::string_view text);

/// The indices of the devices to try for a wish, best first. Devices that CUDA knows come before
/// others; a software driver is tried only if the wish asks for it. Fails with kUnsupported if no
/// device can be the right one.
[[nodiscard]] Result<std::vector<std::size_t>> devicesFor(const DeviceWish& wish,
                                                          std::span<const DeviceFacts> devices);

/// Whether the renderer string belongs to a driver that draws on the processor.
[[nodiscard]] bool isSoftwareRenderer(std::string_view renderer);

/// Checks that an opened context meets the wish: OpenGL 4.5, a graphics processor unless the wish
/// is for software, the right UUID. Fails with kUnsupported; the message names what was found.
[[nodiscard]] Result<void> judgeContext(const DeviceWish& wish, const ContextFacts& context);

/// The error for a machine that has only a software driver, whose renderer string is `name`.
[[nodiscard]] Error onlySoftware(std::string_view name);

}  // namespace galactic::render
