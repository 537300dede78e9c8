// Any bytes as a pack. An even first byte: the rest is the file as it is. An odd one: the rest is
// the payload, and a header with its right size and hash is put before it, so that the checks
// behind the hash are reached; the byte's other bits choose the kind in that header. What opens has
// to be safe to use: grids answer queries alike, one by one and in batches; objects and robots
// show only what is in the pack, the robot moves, and the policy acts.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <span>
#include <vector>

#include "finding.h"
#include "galactic/episode_set.h"
#include "galactic/kinematics.h"
#include "galactic/learned_policy.h"
#include "galactic/object_set.h"
#include "galactic/pack.h"
#include "galactic/pack_reference.h"
#include "galactic/render_library.h"
#include "galactic/render_meshes.h"
#include "galactic/robot.h"
#include "galactic/scene.h"
#include "galactic/schema/pack_generated.h"
#include "support/aligned_bytes.h"
#include "support/oracles/render_mesh_reader.h"

namespace {

using namespace galactic;
using test::reportFinding;

/// Centers over, beside and beyond a grid.
struct Centers {
  std::vector<float> x, y, z;

  explicit Centers(const ColumnGrid& grid) {
    const ColumnGridLayout& layout = grid.layout();
    const float height = layout.heights.hi - layout.heights.lo;
    const std::uint32_t step_x = std::max(1U, layout.columns_x / 16);
    const std::uint32_t step_z = std::max(1U, layout.columns_z / 16);
    for (std::uint32_t k = 0; k <= layout.columns_z && k + step_z > k; k += step_z) {
      for (std::uint32_t i = 0; i <= layout.columns_x && i + step_x > i; i += step_x) {
        for (const float part : {-0.1F, 0.0F, 0.3F, 0.7F, 1.0F}) {
          add(layout.min_x + (static_cast<float>(i) + 0.5F) * layout.spacing,
              layout.heights.lo + part * height,
              layout.min_z + (static_cast<float>(k) + 0.5F) * layout.spacing);
        }
      }
    }
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    add(kNan, 0, 0);
    add(kInfinity, -kInfinity, kInfinity);
  }

  void add(float at_x, float at_y, float at_z) {
    x.push_back(at_x);
    y.push_back(at_y);
    z.push_back(at_z);
  }
};

bool sameBits(float a, float b) { return std::memcmp(&a, &b, sizeof(a)) == 0; }

void query(const ColumnGrid& grid) {
  const Centers centers(grid);
  std::vector<Clearance> clearance(centers.x.size());
  std::vector<float> down(centers.x.size());
  std::vector<float> up(centers.x.size());
  grid.contact({centers.x, centers.y, centers.z}, {clearance, down, up});
  for (std::size_t n = 0; n < centers.x.size(); ++n) {
    const Contact contact = grid.contact({centers.x[n], centers.y[n], centers.z[n]});
    const bool same = contact.clearance == clearance[n] && sameBits(contact.down, down[n]) &&
                      sameBits(contact.up, up[n]);
    if (!same) reportFinding("the batched query differs from the scalar one");
    if (!(contact.down >= 0 && contact.up >= 0)) reportFinding("a negative or undefined distance");
  }
  std::vector<Span> spans(grid.spanCount(grid.columnsX() - 1, grid.columnsZ() - 1));
  grid.spans(grid.columnsX() - 1, grid.columnsZ() - 1, spans);
}

void useScene(const PackFile& pack) {
  const auto scene = Scene::from(pack);
  if (!scene) reportFinding("a pack of scenes without a scene");
  for (const ColumnGrid& grid : scene->grids()) query(grid);
}

/// Whether every sphere has a radius of the working set and a place.
void useSpheres(std::span<const SetSphere> spheres, std::span<const float> radii) {
  for (const SetSphere& sphere : spheres) {
    if (sphere.radius_index >= radii.size()) reportFinding("a sphere without a radius");
    const Vec3& center = sphere.center;
    if (!std::isfinite(center.x) || !std::isfinite(center.y) || !std::isfinite(center.z)) {
      reportFinding("a sphere without a place");
    }
  }
}

void useObjects(const PackFile& pack) {
  const auto set = ObjectSet::from(pack);
  if (!set) reportFinding("a pack of objects without objects");
  for (std::size_t n = 0; n < set->objects().size(); ++n) {
    const ObjectModel& object = set->objects()[n];
    if (set->find(object.name) != n) reportFinding("an object that its name does not find");
    if (object.spheres.empty() || object.stable_poses.empty())
      reportFinding("an object without a part");
    useSpheres(object.spheres, set->radii());
    if (!(object.box.half_extents.x > 0)) reportFinding("a box without volume");
    for (const StablePose& pose : object.stable_poses) {
      if (!(pose.likelihood >= 0 && pose.likelihood <= 1)) reportFinding("a share beyond 0 to 1");
    }
  }
}

void useRobot(const PackFile& pack) {
  const auto robot = Robot::from(pack);
  if (!robot) reportFinding("a pack of a robot without a robot");
  const std::size_t links = robot->links().size();
  std::vector<Pose> poses(links);
  forwardKinematics(robot->links(), {}, robot->startPositions(), poses);
  for (std::size_t n = 0; n < links; ++n) {
    if (robot->findLink(robot->linkName(n)) != n)
      reportFinding("a link that its name does not find");
    if (robot->jointName(n).empty() != (n == 0)) reportFinding("a joint without a name");
  }
  useSpheres(robot->spheres(), robot->radii());
  std::size_t spheres = 0;
  for (const SphereGroup& group : robot->groups()) {
    if (group.link >= links) reportFinding("a group without a link");
    spheres += group.spheres.size();
  }
  if (spheres != robot->spheres().size()) reportFinding("a sphere without a group");
  for (const GroupPair& pair : robot->testedPairs()) {
    if (pair.first >= pair.second || pair.second >= robot->groups().size()) {
      reportFinding("a pair of no two groups");
    }
  }
  for (const ControlledJoint& joint : robot->controlledJoints()) {
    if (joint.position >= robot->positionCount()) reportFinding("an action without a joint");
  }
  if (robot->endEffector() && robot->endEffector()->link >= links)
    reportFinding("a hand without a link");
  if (robot->camera() && robot->camera()->link >= links) reportFinding("a camera without a link");
  if (robot->laser() && robot->laser()->link >= links) reportFinding("a laser without a link");
}

void useEpisodes(const PackFile& pack) {
  const auto set = EpisodeSet::from(pack);
  if (!set) reportFinding("a pack of episodes without episodes");
  for (std::size_t n = 0; n < set->episodes().size(); ++n) {
    const Episode& episode = set->episodes()[n];
    if (episode.scene >= set->sceneNames().size()) reportFinding("an episode without a scene");
    if (!std::isfinite(episode.base_position.y) || !std::isfinite(episode.base_yaw)) {
      reportFinding("an episode that starts nowhere");
    }
    if (episode.target >= set->placements(episode).size())
      reportFinding("an episode without a target");
    for (const Placement& placement : set->placements(episode)) {
      if (placement.object >= set->objectNames().size())
        reportFinding("a placement without an object");
      const Quat& turn = placement.pose.rotation;
      if (!(turn.x * turn.x + turn.w * turn.w <= 1.1F))
        reportFinding("a placement without a rotation");
    }
    for (const float position : set->startPositions(n)) {
      if (!std::isfinite(position)) reportFinding("a joint that starts nowhere");
    }
  }
}

void useWorld(const PackFile& pack) {
  const auto references = packReferences(pack);
  if (!references) reportFinding("a pack of a world without a list");
  const auto task = taskOptions(pack);
  SimulationOptions options;
  if (!task || setOptions(*task, OptionScope::kTask, options)) {
    reportFinding("a pack of a world whose task is none");
  }
  for (const PackReference& reference : *references) {
    const std::filesystem::path path(reference.path);
    if (path.empty() || path.is_absolute()) reportFinding("a listed pack that may lie anywhere");
    for (const auto& part : path) {
      if (part == "..") reportFinding("a listed pack outside the folder");
    }
  }
}

void useTexture(const PackFile& pack) {
  SharedTextures textures;
  if (!textures.add(pack)) reportFinding("a texture pack whose texture is not read");
  const schema::SharedTexture& stored = *pack.root().asset_as_SharedTexture();
  const RenderTexture* texture = textures.find(stored.hash()->low(), stored.hash()->high());
  if (texture == nullptr) reportFinding("a texture that is not found by its hash");
  if (texture->texels.size() != textureBytes(texture->size, texture->format)) {
    reportFinding("a texture with too few or too many texels");
  }
}

/// Acts for two steps on two envs; what takes too much memory or time is left out.
void usePolicy(const PackFile& pack) {
  const auto needs = policyInterface(pack);
  if (!needs) reportFinding("a policy pack without a policy");
  PolicyBatch batch{.envs = 2,
                    .actions = std::size_t{needs->continuous_actions} + needs->discrete_actions,
                    .observation_size = 0,
                    .observation = {},
                    .robot = {}};
  for (const PolicyPart& part : needs->observation) {
    batch.observation.push_back({part.name, batch.observation_size, part.size});
    batch.observation_size += part.size;
  }
  constexpr std::size_t kMost = 1U << 16U;
  const std::size_t pixels =
      needs->image ? std::size_t{needs->image->width} * needs->image->height : 0;
  if (batch.observation_size > kMost || batch.actions > kMost || pixels > kMost) return;
  auto policy = LearnedPolicy::create(pack, batch, {.threads = 1});
  if (!policy) reportFinding("a policy that does not fit what it asks for");
  const std::vector<float> observations(batch.envs * batch.observation_size, 0.5F);
  const std::vector<std::uint8_t> color(batch.envs * pixels * 3, 100);
  const std::vector<float> depth(batch.envs * pixels, 2);
  const std::vector<std::uint8_t> dones{0, 1};
  std::vector<float> actions(batch.envs * batch.actions);
  for (int step = 0; step < 2; ++step) {
    policy->act({observations, dones, color, depth}, actions);
  }
}

void draw(const PackFile& pack) {
  const auto meshes = renderMeshesOf(pack);
  if (!meshes) reportFinding("a pack whose render meshes are not read");
  if (!*meshes) return;
  if (const char* offence = test::drawingOffence(**meshes)) reportFinding(offence);
}

void use(const PackFile& pack) {
  const std::array without_meshes{PackKind::kEpisodes, PackKind::kWorld, PackKind::kTexture,
                                  PackKind::kPolicy};
  if (std::ranges::find(without_meshes, pack.kind()) == without_meshes.end()) draw(pack);
  switch (pack.kind()) {
    case PackKind::kScene:
      return useScene(pack);
    case PackKind::kObjects:
      return useObjects(pack);
    case PackKind::kRobot:
      return useRobot(pack);
    case PackKind::kEpisodes:
      return useEpisodes(pack);
    case PackKind::kWorld:
      return useWorld(pack);
    case PackKind::kTexture:
      return useTexture(pack);
    case PackKind::kPolicy:
      return usePolicy(pack);
  }
}

/// The kinds of header for a payload; odd first bytes count through them.
constexpr std::array kKinds{PackKind::kScene,    PackKind::kObjects, PackKind::kRobot,
                            PackKind::kEpisodes, PackKind::kWorld,   PackKind::kTexture,
                            PackKind::kPolicy};

test::AlignedBytes fileOf(const std::uint8_t* data, std::size_t size) {
  const auto* first = reinterpret_cast<const std::byte*>(data);
  std::vector<std::byte> file(first + 1, first + size);
  if (data[0] % 2 == 1) {
    const PackHeader header = makePackHeader(kKinds[(data[0] / 2) % kKinds.size()], file);
    const auto* bytes = reinterpret_cast<const std::byte*>(&header);
    file.insert(file.begin(), bytes, bytes + sizeof(header));
  }
  return test::AlignedBytes(file);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const test::AlignedBytes file = fileOf(data, size);
  const auto pack = PackFile::view(file.bytes(), "fuzz.pack");
  if (pack) {
    use(*pack);
  } else if (pack.error().where.empty() || pack.error().message.empty()) {
    reportFinding("an error without place or message");
  }
  return 0;
}
