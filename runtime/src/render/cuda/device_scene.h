#pragma once
#include <map>
#include <vector>

#include "galactic/render_library.h"
#include "render/cuda/driver.h"
#include "render/raster/pane_task.h"
#include "render/raster/tables.h"

namespace galactic::render::cuda {

/// A library in the memory of a device, as the kernels read it. The device's context must be
/// current during all calls, including the destructor's.
class DeviceScene {
 public:
  /// Uploads the library, which is not needed afterwards. Fails if there is too little memory.
  [[nodiscard]] static Result<DeviceScene> upload(const RenderLibrary& library,
                                                  const Driver& driver);

  /// Addresses on the device: ModelTables, in the order of the library, and the bases of texels.
  [[nodiscard]] DeviceAddress models() const { return models_; }
  [[nodiscard]] DeviceAddress texelBases() const { return texel_bases_; }
  /// In the order of the library's models.
  [[nodiscard]] const std::vector<std::uint32_t>& clusterCounts() const { return cluster_counts_; }

 private:
  explicit DeviceScene(const Driver& driver) : driver_(&driver) {}

  /// Copies an array to the device; returns address 0 if it is empty.
  template <class Values>
  Result<DeviceAddress> put(const Values& values);
  Result<PackTables> putPack(const RenderMeshes& meshes, std::vector<DeviceAddress>& bases);

  const Driver* driver_;
  std::vector<Memory> memories_;
  DeviceAddress models_ = 0;
  DeviceAddress texel_bases_ = 0;
  std::vector<std::uint32_t> cluster_counts_;
  /// Where textures are. Only looked up, never iterated, so the order of addresses does not matter.
  std::map<TextureKey, SurfaceTexels> known_;
};

}  // namespace galactic::render::cuda
