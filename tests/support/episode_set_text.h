#pragma once

namespace galactic::test {

/// A published episode set in small: three scenes, of which two are used, three objects, of which
/// two are used, spawns that two episodes share, two start joints.
inline constexpr const char* kSmallEpisodeSet = R"({"episodeSet": {
  "renderAssets": [{"name": "stage_b"}, {"name": "mug"}, {"name": "can"}, {"name": "box"}],
  "staticScenes": [
    {"name": "b_room", "columnGridSetName": "b_room", "renderAssetInstances": []},
    {"name": "unused_room", "columnGridSetName": "unused_room", "renderAssetInstances": []},
    {"name": "a_room", "columnGridSetName": "a_room", "renderAssetInstances": []}],
  "freeObjects": [
    {"renderAssetIndex": 1, "startRotations": []},
    {"renderAssetIndex": 3, "startRotations": []},
    {"renderAssetIndex": 2, "startRotations": []}],
  "freeObjectSpawns": [
    {"freeObjIndex": 0, "startRotation": [1, 0, 0, 0], "startPos": [1, 2, 3]},
    {"freeObjIndex": 2, "startRotation": [0.7071068, -0.7071068, 0, 0], "startPos": [4, 5, 6]},
    {"freeObjIndex": 0, "startRotation": [0, 0, 1, 0], "startPos": [7, 8, 9]},
    {"freeObjIndex": 1, "startRotation": [1, 0, 0, 0], "startPos": [0, 0, 0]}],
  "episodes": [
    {"staticSceneIndex": 0, "firstFreeObjectSpawnIndex": 0, "numFreeObjectSpawns": 2,
     "targetObjIndex": 1, "agentStartPos": [0.5, -0.25], "agentStartYaw": 1.5,
     "robotStartJointPositions": [0.125, -0.5], "targetObjGoalPos": [-1, 1, -2],
     "targetObjGoalRotation": [0.7071068, -0.7071068, 0, 0]},
    {"staticSceneIndex": 2, "firstFreeObjectSpawnIndex": 1, "numFreeObjectSpawns": 2,
     "targetObjIndex": 0, "agentStartPos": [2, 3], "agentStartYaw": -3,
     "robotStartJointPositions": [1, 2], "targetObjGoalPos": [4, 1, 5],
     "targetObjGoalRotation": [1, 0, 0, 0]}]
}})";

}  // namespace galactic::test
