#include "render/device_wish.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace galactic::render {
namespace {

constexpr const char* kWhere = "render device";

std::optional<std::uint32_t> numberIn(std::string_view text) {
  std::uint32_t number = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (text.empty() || error != std::errc() || stop != end) return std::nullopt;
  return number;
}

std::optional<std::uint8_t> hexDigit(char digit) {
  if (digit >= '0' && digit <= '9') return static_cast<std::uint8_t>(digit - '0');
  if (digit >= 'a' && digit <= 'f') return static_cast<std::uint8_t>(digit - 'a' + 10);
  if (digit >= 'A' && digit <= 'F') return static_cast<std::uint8_t>(digit - 'A' + 10);
  return std::nullopt;
}

std::optional<DeviceUuid> uuidIn(std::string_view text) {
  constexpr std::string_view kPrefix = "GPU-";
  if (text.starts_with(kPrefix)) text.remove_prefix(kPrefix.size());
  DeviceUuid uuid{};
  std::size_t digits = 0;
  for (const char letter : text) {
    if (letter == '-') continue;
    const std::optional<std::uint8_t> value = hexDigit(letter);
    if (!value || digits == 2 * uuid.size()) return std::nullopt;
    std::uint8_t& byte = uuid[digits / 2];
    byte = static_cast<std::uint8_t>(byte * 16 + *value);
    ++digits;
  }
  if (digits != 2 * uuid.size()) return std::nullopt;
  return uuid;
}

std::string textOf(const DeviceUuid& uuid) {
  std::string text;
  for (std::size_t i = 0; i < uuid.size(); ++i) {
    const bool dash = i == 4 || i == 6 || i == 8 || i == 10;
    text += fmt::format("{}{:02x}", dash ? "-" : "", uuid[i]);
  }
  return text;
}

std::string listOf(std::span<const DeviceFacts> devices) {
  std::string list;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const DeviceFacts& device = devices[i];
    list += fmt::format("{}{} ({}{}{})", i == 0 ? "" : ", ", i, device.name,
                        device.software ? ", software" : "",
                        device.cuda ? fmt::format(", cuda:{}", *device.cuda) : "");
  }
  return list.empty() ? "none" : list;
}

template <class Matches>
std::vector<std::size_t> matching(std::span<const DeviceFacts> devices, Matches matches) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if (matches(devices[i])) found.push_back(i);
  }
  return found;
}

/// Graphics processors; those that CUDA knows come first, since Mesa may list an NVIDIA card a
/// second time, as a device that cannot draw.
std::vector<std::size_t> graphicsProcessors(std::span<const DeviceFacts> devices) {
  std::vector<std::size_t> found =
      matching(devices, [](const DeviceFacts& device) { return !device.software; });
  std::stable_partition(found.begin(), found.end(),
                        [&](std::size_t device) { return devices[device].cuda.has_value(); });
  return found;
}

Result<std::vector<std::size_t>> withIndex(const DeviceWish& wish,
                                           std::span<const DeviceFacts> devices) {
  if (wish.number >= devices.size()) {
    return fail(ErrorCode::kUnsupported, kWhere,
                fmt::format("found no device {}; EGL lists {}", wish.number, listOf(devices)));
  }
  if (devices[wish.number].software) {
    return fail(ErrorCode::kUnsupported, kWhere,
                fmt::format("device {} is a software driver, not a graphics processor; ask for "
                            "\"software\" or the soft backend for software. EGL lists {}",
                            wish.number, listOf(devices)));
  }
  return std::vector<std::size_t>{wish.number};
}

Result<std::vector<std::size_t>> withCuda(const DeviceWish& wish,
                                          std::span<const DeviceFacts> devices) {
  std::vector<std::size_t> found = matching(
      devices, [&](const DeviceFacts& device) { return device.cuda == std::int64_t{wish.number}; });
  if (found.empty()) {
    return fail(ErrorCode::kUnsupported, kWhere,
                fmt::format("found no device that is cuda:{}; EGL lists {}. CUDA_VISIBLE_DEVICES "
                            "changes CUDA's numbers, and a container needs the driver capability "
                            "\"graphics\"",
                            wish.number, listOf(devices)));
  }
  return found;
}

}  // namespace

Result<DeviceWish> parseDeviceWish(std::string_view text) {
  constexpr std::string_view kCuda = "cuda:";
  if (text.empty()) return DeviceWish{};
  if (text == "software") return DeviceWish{.kind = DeviceWish::Kind::kSoftware};
  if (const auto number = numberIn(text)) {
    return DeviceWish{.kind = DeviceWish::Kind::kIndex, .number = *number};
  }
  if (text.starts_with(kCuda)) {
    if (const auto number = numberIn(text.substr(kCuda.size()))) {
      return DeviceWish{.kind = DeviceWish::Kind::kCuda, .number = *number};
    }
  }
  if (const auto uuid = uuidIn(text)) {
    return DeviceWish{.kind = DeviceWish::Kind::kUuid, .uuid = *uuid};
  }
  return fail(ErrorCode::kInvalidInput, kWhere,
              fmt::format("found \"{}\"; expected an index such as 0, cuda:0, a UUID of 32 "
                          "hexadecimal digits, software, or nothing for the first graphics "
                          "processor",
                          text));
}

Result<std::vector<std::size_t>> devicesFor(const DeviceWish& wish,
                                            std::span<const DeviceFacts> devices) {
  using Kind = DeviceWish::Kind;
  if (wish.kind == Kind::kIndex) return withIndex(wish, devices);
  if (wish.kind == Kind::kCuda) return withCuda(wish, devices);
  if (wish.kind == Kind::kSoftware) {
    return matching(devices, [](const DeviceFacts& device) { return device.software; });
  }
  std::vector<std::size_t> found = graphicsProcessors(devices);
  if (found.empty() && !devices.empty()) {
    return tl::unexpected<Error>(onlySoftware(devices.front().name));
  }
  return found;
}

bool isSoftwareRenderer(std::string_view renderer) {
  constexpr std::array<std::string_view, 4> kNames{"llvmpipe", "softpipe", "swrast",
                                                   "Software Rasterizer"};
  return std::ranges::any_of(
      kNames, [&](std::string_view name) { return renderer.find(name) != std::string_view::npos; });
}

Result<void> judgeContext(const DeviceWish& wish, const ContextFacts& context) {
  if (context.major < 4 || (context.major == 4 && context.minor < 5)) {
    return fail(ErrorCode::kUnsupported, kWhere,
                fmt::format("the driver \"{}\" has OpenGL {}.{}; expected 4.5 or newer: update the "
                            "driver, or use the soft backend",
                            context.renderer, context.major, context.minor));
  }
  const bool software = isSoftwareRenderer(context.renderer);
  if (wish.kind == DeviceWish::Kind::kSoftware) {
    if (software) return {};
    return fail(ErrorCode::kUnsupported, kWhere,
                fmt::format("found the graphics processor \"{}\"; expected a software driver: "
                            "install libgl1-mesa-dri, or use the soft backend",
                            context.renderer));
  }
  if (software) return tl::unexpected<Error>(onlySoftware(context.renderer));
  if (wish.kind == DeviceWish::Kind::kUuid && context.uuid != wish.uuid) {
    return fail(
        ErrorCode::kUnsupported, kWhere,
        fmt::format("the graphics processor \"{}\" has the UUID {}; expected {}", context.renderer,
                    context.uuid ? textOf(*context.uuid) : "unknown", textOf(wish.uuid)));
  }
  return {};
}

Error onlySoftware(std::string_view name) {
  return {
      ErrorCode::kUnsupported, kWhere,
      fmt::format("found only the software driver \"{}\"; expected a graphics processor: ask for "
                  "the device \"software\" or use the soft backend, or install the graphics "
                  "processor's driver (in a container, with the capability \"graphics\")",
                  name)};
}

}  // namespace galactic::render
