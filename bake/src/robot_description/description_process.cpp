#include "robot_description/description_process.h"

#include <fmt/format.h>

#include <string_view>
#include <system_error>
#include <utility>

#include "import/isolated_process.h"
#include "import/transfer_archive.h"
#include "robot_description/urdf/urdf_reader.h"
#include "support/try.h"

namespace galactic::bake {

template <class Archive>
void transferFields(Archive& archive, Is<DescribedShape> auto& shape) {
  archive(shape.geometry, shape.size, shape.mesh, shape.link_from_shape, shape.has_color,
          shape.color, shape.texture, shape.own_mesh, shape.hides_looks);
}

template <class Archive>
void transferFields(Archive& archive, Is<DescribedMass> auto& mass) {
  archive(mass.mesh, mass.has_mass, mass.mass, mass.density);
}

template <class Archive>
void transferFields(Archive& archive, Is<LinkInertial> auto& inertial) {
  archive(inertial.link, inertial.mass, inertial.center, inertial.moments);
}

template <class Archive>
void transferFields(Archive& archive, Is<DescribedLink> auto& link) {
  archive(link.name, link.visuals, link.collisions, link.inertials, link.masses, link.is_camera);
}

template <class Archive>
void transferFields(Archive& archive, Is<DescribedJoint> auto& joint) {
  archive(joint.name, joint.parent, joint.child, joint.type, joint.parent_from_joint, joint.axis,
          joint.has_limits, joint.lower, joint.upper, joint.mimic, joint.multiplier, joint.offset,
          joint.has_rest, joint.rest);
}

template <class Archive>
void transferFields(Archive& archive, Is<DescribedMesh> auto& mesh) {
  archive(mesh.name, mesh.points, mesh.triangles);
}

template <class Archive>
void transferFields(Archive& archive, Is<DescribedPair> auto& pair) {
  archive(pair.first, pair.second);
}

template <class Archive>
void transferFields(Archive& archive, Is<RobotDescription> auto& robot) {
  archive(robot.name, robot.links, robot.joints, robot.meshes, robot.total_mass, robot.touching,
          robot.included, robot.absent, robot.warnings);
}

template <class Archive>
void transferFields(Archive& archive, Is<LinkSpheres> auto& link) {
  archive(link.link, link.spheres);
}

namespace {

namespace fs = std::filesystem;

/// XML trees take a few dozen bytes per byte of text.
constexpr std::uint64_t kMemoryLimit = std::uint64_t{8} << 30U;

Error processFailure(const fs::path& path, const ProcessFailure& failure) {
  Error error{.code = ErrorCode::kInvalidInput, .where = path.string(), .message = {}};
  switch (failure.end) {
    case ProcessEnd::kNotStarted:
      error.code = ErrorCode::kInternal;
      error.message = fmt::format("cannot start a process to read it: {}",
                                  std::generic_category().message(failure.number));
      break;
    case ProcessEnd::kTimeLimit:
      error.message =
          "the XML parser did not finish in time; the file is broken: generate it again";
      break;
    case ProcessEnd::kMemoryLimit:
      error.message =
          "the XML parser ran out of memory; the file is broken or too large: generate it again";
      break;
    case ProcessEnd::kCrashed:
    case ProcessEnd::kFailed:
      error.message = "the XML parser crashed; the file is broken: generate it again";
      break;
  }
  return error;
}

/// Parses a file in a child process; `parse` returns a Result<T>.
template <class T, class Parse>
Result<T> parseIsolated(const fs::path& path, std::chrono::seconds time_limit, Parse parse) {
  ASSIGN_OR_RETURN(const auto text, readRobotText(path));
  const auto work = [&](ProcessChannel& channel) {
    const TransferSink sink = [&](std::span<const std::byte> bytes) { channel.write(bytes); };
    TransferWriter writer(sink);
    const Result<T> parsed = parse(text);
    writer(parsed.has_value());
    if (parsed) {
      writer(*parsed);
    } else {
      writer(parsed.error());
    }
  };
  const auto output = runIsolated(work, {.wall_clock = time_limit, .memory = kMemoryLimit});
  if (!output) return tl::unexpected(processFailure(path, output.error()));
  TransferReader reader(output->bytes());
  bool good = false;
  T value;
  Error error;
  reader(good);
  if (good) {
    reader(value);
  } else {
    reader(error);
  }
  if (!reader.good() || !reader.atEnd()) {
    return fail(ErrorCode::kInternal, path.string(),
                "the reading process delivered a broken result; please report this with the file");
  }
  if (!good) return tl::unexpected(std::move(error));
  return value;
}

}  // namespace

Result<RobotDescription> readDescription(const fs::path& path, const DescriptionRequest& request,
                                         std::chrono::seconds time_limit) {
  return parseIsolated<RobotDescription>(path, time_limit, [&](const std::string& text) {
    return parseDescription(text, path, request);
  });
}

Result<std::vector<LinkSpheres>> readSrdf(const fs::path& path, std::chrono::seconds time_limit) {
  return parseIsolated<std::vector<LinkSpheres>>(
      path, time_limit, [&](const std::string& text) { return parseSrdf(text, path.string()); });
}

}  // namespace galactic::bake
