#pragma once
#include <map>
#include <vector>

#include "galactic/render_library.h"
#include "render/cuda/driver.h"
#include "render/raster/pane_task.h"
#include "render/raster/tables.h"

namespace galactic::render::cuda {

/// A library in the memory of a device, as the kernels read it. The device's context must be
/// current for all calls, also for the destructor.
class DeviceScene {
 public:
  /// Uploads; the library is not needed afterwards. Fails where memory is short.
  [[nodiscard]] static Result<DeviceScene> upload(const RenderLibrary& library,
                                                  const Driver& driver);

  /// On the device: ModelTables by the numbers of the library, bases of texels.
  [[nodiscard]] DeviceAddress models() const { return models_; }
  [[nodiscard]] DeviceAddress texelBases() const { return texel_bases_; }
  /// By the numbers of the library.
  [[nodiscard]] const std::vector<std::uint32_t>& clusterCounts() const { return cluster_counts_; }

 private:
  explicit DeviceScene(const Driver& driver) : driver_(&driver) {}

  /// Copies an array; address 0 where it is empty.
  template <class Values>
  Result<DeviceAddress> put(const Values& values);
  Result<PackTables> putPack(const RenderMeshes& meshes, std::vector<DeviceAddress>& bases);

  const Driver* driver_;
  std::vector<Memory> memories_;
  DeviceAddress models_ = 0;
  DeviceAddress texel_bases_ = 0;
  std::vector<std::uint32_t> cluster_counts_;
  /// Where textures are. Asked, never walked through.
  std::map<TextureKey, SurfaceTexels> known_;
};

}  // namespace galactic::render::cuda
