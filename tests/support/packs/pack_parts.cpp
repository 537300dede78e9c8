#include "support/packs/pack_parts.h"

#include <algorithm>
#include <cstring>
#include <tuple>

namespace galactic::test {

void sortSpheres(std::span<SetSphere> spheres) {
  const auto key = [](const SetSphere& sphere) {
    const Vec3& at = sphere.center;
    return std::tuple(-static_cast<std::int64_t>(sphere.radius_index), at.x, at.y, at.z);
  };
  std::sort(spheres.begin(), spheres.end(),
            [&](const SetSphere& a, const SetSphere& b) { return key(a) < key(b); });
}

AlignedBytes packFile(PackKind kind, std::span<const std::byte> payload) {
  const PackHeader header = makePackHeader(kind, payload);
  std::vector<std::byte> file(sizeof(header));
  std::memcpy(file.data(), &header, sizeof(header));
  file.insert(file.end(), payload.begin(), payload.end());
  return AlignedBytes(file);
}

}  // namespace galactic::test
