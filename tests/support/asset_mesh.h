#pragma once
#include <filesystem>
#include <string>

#include "galactic/bake/mesh_import.h"
#include "galactic/bake/triangle_mesh.h"
#include "support/assets.h"
#include "support/try.h"

namespace galactic::test {

/// Real scenes that the bake's tests run on, relative to the assets folder.
inline constexpr const char* kApartmentStage = "replica_cad/stages/Stage_v3_sc1_staging.obj";
inline constexpr const char* kScannedRoom = "scenes/scan_polycam_room/room.glb";
inline constexpr const char* kOffice = "scenes/cpr_office/office.dae";

/// Whether the asset is on this machine; tests skip with a message where it is not.
inline bool hasAsset(const std::string& relative) {
  const std::filesystem::path folder = assetsFolder();
  return !folder.empty() && std::filesystem::is_regular_file(folder / relative);
}

/// The collision geometry of an asset.
inline Result<bake::TriangleMesh> loadAsset(const std::string& relative) {
  ASSIGN_OR_RETURN(auto asset, bake::importMesh(assetsFolder() / relative));
  ASSIGN_OR_RETURN(auto clean, bake::placeAndClean(asset));
  return std::move(clean.mesh);
}

}  // namespace galactic::test
