#pragma once
#include <vector>

#include "galactic/bake/episode_generator.h"
#include "support/homes/sample_world.h"

namespace galactic::test {

/// The sample world, baked once for all that is asked here: baking takes seconds.
class SampleWorld {
 public:
  SampleWorld()
      : scene_pack_(bakeSampleApartment()),
        object_pack_(bakeSampleObjects()),
        robot_pack_(bakeSampleRobot()),
        scenes{MemoryPack::opened(Scene::from(scene_pack_.pack()))},
        objects(MemoryPack::opened(ObjectSet::from(object_pack_.pack()))),
        robot(MemoryPack::opened(Robot::from(robot_pack_.pack()))) {}

  [[nodiscard]] bake::EpisodeInputs inputs() const {
    bake::EpisodeInputs inputs;
    inputs.packs = {&scene_pack_.pack(), &object_pack_.pack(), &robot_pack_.pack()};
    return inputs;
  }

 private:
  MemoryPack scene_pack_;
  MemoryPack object_pack_;
  MemoryPack robot_pack_;

 public:
  std::vector<Scene> scenes;
  ObjectSet objects;
  Robot robot;
};

}  // namespace galactic::test
