// Writes for the tests of pages: the small home, the same without meshes, a recording of a run in
// it with the poses that the simulator had, and packs whose names are markup.
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <vector>

#include "galactic/batch_simulator.h"
#include "galactic/kinematics.h"
#include "pack_tool/painted_meshes.h"
#include "run/recording.h"
#include "support/homes/small_home_models.h"
#include "support/scratch_folder.h"
#include "view/json_writer.h"

namespace galactic::test {
namespace {

void write(const std::filesystem::path& file, const AlignedBytes& pack) {
  const std::span<const std::byte> bytes = pack.bytes();
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  if (!stream.flush()) throw std::runtime_error(file.string() + " cannot be written");
}

void writeHome(const WorldFields& fields, const std::filesystem::path& folder) {
  const ScratchFolder scratch;
  const std::filesystem::path world = writeWorld(scratch, fields);
  std::filesystem::copy(
      world.parent_path(), folder,
      std::filesystem::copy_options::overwrite_existing | std::filesystem::copy_options::recursive);
  std::filesystem::rename(folder / world.filename(), folder / "world.pack");
}

/// Objects with textures of noise.
void writePainted(const std::filesystem::path& folder) {
  ObjectPackFields objects = smallObjects();
  objects.render_meshes = paintedMeshes({.parts = {0, 1}});
  write(folder / "painted.pack", buildPack(objects));
}

void writeHostile(const std::filesystem::path& folder) {
  constexpr const char* kMarkup = "</script><img src=x onerror=\"document.title='owned'\">";
  WorldFields world = smallHomeWorldWithModels();
  world.scene.name = kMarkup;
  world.scene.warning = kMarkup;
  write(folder / "hostile_scene.pack", buildPack(world.scene));
  world.objects.objects.front().name = kMarkup;
  write(folder / "hostile_objects.pack", buildPack(world.objects));
  world.robot.name = kMarkup;
  world.robot.link_names.back() = kMarkup;
  world.robot.joint_names.back() = kMarkup;
  write(folder / "hostile_robot.pack", buildPack(world.robot));
}

template <class T>
T valueOf(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().text());
  return std::move(*result);
}

void writePose(JsonWriter& json, const Pose& pose) {
  json.numbers("", std::span<const float>(&pose.translation.x, 7));
}

/// Where the links and objects of each env are: "links" and "objects" of env after env.
void writeFrame(JsonWriter& json, const Robot& robot, const BatchSimulator& simulator) {
  json.begin("", '[');
  for (std::size_t env = 0; env < simulator.envCount(); ++env) {
    const EnvState state = simulator.envState(env);
    const EnvObjects objects = simulator.envObjects(env);
    std::vector<Pose> links(robot.links().size());
    forwardKinematics(robot.links(), state.world_from_root, state.joint_positions, links);
    json.begin("", '{');
    json.begin("links", '[');
    for (const Pose& pose : links) writePose(json, pose);
    json.end(']');
    json.begin("objects", '[');
    for (std::size_t n = 0; n < objects.objects.size(); ++n) {
      const bool is_held = objects.held == static_cast<std::int32_t>(n);
      writePose(json, is_held ? objects.world_from_held : objects.objects[n]);
    }
    json.end(']');
    json.end('}');
  }
  json.end(']');
}

void writeRun(const std::filesystem::path& folder) {
  constexpr std::size_t kSteps = 60;
  const std::filesystem::path path = folder / "world.pack";
  const World world = valueOf(World::open({&path, 1}));
  SimulationOptions options;
  options.envs = 3;
  options.task.most_steps = 25;
  BatchSimulator simulator = valueOf(BatchSimulator::create(world, options));
  const RecordingSubject subject{options, static_cast<std::uint32_t>(simulator.actionCount()),
                                 stampsOf(world)};
  RecordingWriter recording = valueOf(RecordingWriter::create(folder / "run.rec", subject));
  std::vector<float> actions(simulator.envCount() * simulator.actionCount());
  JsonWriter json;
  json.begin('[');
  writeFrame(json, world.robot(), simulator);
  for (std::size_t step = 0; step < kSteps; ++step) {
    for (std::size_t n = 0; n < actions.size(); ++n) {
      actions[n] = std::sin(0.9F * static_cast<float>(n + 1) + 0.05F * static_cast<float>(step));
      if (n % simulator.actionCount() == kTerminate) actions[n] = 0;
    }
    simulator.step(actions);
    if (!recording.append(actions, digestOf(simulator))) throw std::runtime_error("run.rec");
    writeFrame(json, world.robot(), simulator);
  }
  if (!recording.finish()) throw std::runtime_error("run.rec cannot be written");
  json.end(']');
  std::ofstream(folder / "poses.json") << json.take();
}

}  // namespace
}  // namespace galactic::test

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: view_test_packs FOLDER\n", stderr);
    return 1;
  }
  try {
    std::filesystem::create_directories(argv[1]);
    const std::filesystem::path folder = argv[1];
    galactic::test::writeHome(galactic::test::smallHomeWorldWithModels(), folder);
    galactic::test::writeHome(galactic::test::smallHomeWorld(), folder / "bare");
    galactic::test::writeRun(folder);
    galactic::test::writePainted(folder);
    galactic::test::writeHostile(folder);
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "%s\n", problem.what());
    return 4;
  }
  return 0;
}
