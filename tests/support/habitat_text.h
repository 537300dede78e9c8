#pragma once

namespace galactic::test {

/// A rearrangement dataset of Habitat in small: two episodes in two scenes, the first with two
/// targets and an open drawer, objects that come twice, a start with a heading and one without.
inline constexpr const char* kSmallHabitatSet = R"({"config": null, "episodes": [
  {"episode_id": "0",
   "scene_id": "data/replica_cad/configs/scenes/v3_sc1_staging_05.scene_instance.json",
   "scene_dataset_config": "data/replica_cad/replicaCAD.scene_dataset_config.json",
   "additional_obj_config_paths": ["data/objects/ycb/configs/"],
   "start_position": [1.5, 0.125, -2.5],
   "start_rotation": [0, 0.7071068, 0, 0.7071068],
   "info": {"object_labels": {"mug_:0001": "any_targets|0"}},
   "ao_states": {"kitchen_counter_:0000": {"7": 0.45, "6": 0}},
   "rigid_objs": [
     ["003_cracker_box.object_config.json",
      [[1, 0, 0, 0.5], [0, 1, 0, 1], [0, 0, 1, -0.25], [0, 0, 0, 1]]],
     ["mug.object_config.json",
      [[0, 0, 1, 2], [0, 1, 0, 1.25], [-1, 0, 0, 3], [0, 0, 0, 1]]],
     ["data/objects/mug.object_config.json",
      [[1, 0, 0, 4], [0, 0, -1, 0.5], [0, 1, 0, 5], [0, 0, 0, 1]]]],
   "targets": {
     "mug_:0001": [[1, 0, 0, 0.75], [0, 1, 0, 0.5], [0, 0, 1, 1.75], [0, 0, 0, 1]],
     "003_cracker_box_:0000": [[0, 0, 1, -1], [0, 1, 0, 0.25], [-1, 0, 0, -2], [0, 0, 0, 1]]},
   "markers": [{"name": "drawer", "type": "articulated_object",
                "params": {"offset": [0.1, 0, 0], "link": "drawer", "object": "counter"}}],
   "target_receptacles": [["frl_apartment_table_01_:0000", null]],
   "goal_receptacles": [["kitchen_counter_:0000", 7]],
   "name_to_receptacle": {"mug_:0001": "receptacle_table"}},
  {"episode_id": "1", "scene_id": "v3_sc0_staging_00",
   "start_position": [0, 0, 0], "start_rotation": [0, 0, 0, 1], "ao_states": {},
   "rigid_objs": [
     ["mug", [[1, 0, 0, 1], [0, 1, 0, 1], [0, 0, 1, 1], [0, 0, 0, 1]]]],
   "targets": {"mug_:0000": [[1, 0, 0, 2], [0, 1, 0, 1], [0, 0, 1, 1], [0, 0, 0, 1]]}}]})";

}  // namespace galactic::test
