#pragma once
#include <cstdint>
#include <vector>

#include "galactic/object_set.h"
#include "galactic/pose.h"
#include "galactic/scene.h"
#include "galactic/simulation_options.h"
#include "simulation/random_stream.h"
#include "simulation/resting_objects.h"

namespace galactic::simulation {

struct Surroundings {
  const Scene& scene;
  const RestingObjects& objects;
};

class PlacementScratch {
 public:
  explicit PlacementScratch(std::size_t most_spheres) : values(3 * most_spheres) {}
  std::vector<float> values;
  RadiusRange ranges[8];
};

struct Landing {
  Pose pose;
  bool placed = false;
  std::uint32_t attempts = 0;
};
std::size_t paddedObjectSpheres(const ObjectModel& m);
SphereBatch holdSpheres(const ObjectModel&, const Pose&, PlacementScratch&);
Landing placeObject(const Surroundings&, const ObjectModel&, const Pose& released, RandomStream&,
                    const PlacementOptions&, PlacementScratch&);
}  // namespace galactic::simulation
