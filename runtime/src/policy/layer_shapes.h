#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "galactic/error.h"

namespace galactic::schema {
struct Policy;
}

namespace galactic::policy {

/// The shape of a layer's value.
struct LayerShape {
  std::uint32_t channels = 0;
  std::uint32_t height = 1;
  std::uint32_t width = 1;

  [[nodiscard]] std::uint64_t pixels() const { return std::uint64_t{height} * width; }
  [[nodiscard]] std::uint64_t size() const { return pixels() * channels; }
  [[nodiscard]] bool isVector() const { return height == 1 && width == 1; }
  friend bool operator==(const LayerShape&, const LayerShape&) = default;
};

/// Limits for the elements of all layers' values together, and of their weights as laid out for
/// running: far above any real policy, far below the memory of a machine.
inline constexpr std::uint64_t kMostValues = std::uint64_t{1} << 24U;
inline constexpr std::uint64_t kMostWeights = std::uint64_t{1} << 27U;
/// Limit for the multiplications that compute the actions of one env.
inline constexpr std::uint64_t kMostProducts = std::uint64_t{1} << 33U;
/// Results that are computed together; weights are padded to a multiple of this.
inline constexpr std::uint32_t kBlock = 16;

/// Computes the shapes of all layers and checks that every weight is there and finite, before any
/// memory is allocated for them. `where` names the policy. Fails with kInvalidInput.
[[nodiscard]] Result<std::vector<LayerShape>> layerShapes(const schema::Policy& policy,
                                                          const std::string& where);

}  // namespace galactic::policy
