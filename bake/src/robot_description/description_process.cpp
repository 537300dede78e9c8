#include "robot_description/description_process.h"

#include <fmt/format.h>

#include <string_view>
#include <system_error>
#include <utility>

#include "galactic/bake/robot_import.h"
#include "import/isolated_process.h"
#include "import/transfer_archive.h"
#include "robot_description/urdf/urdf_reader.h"
#include "support/files/mapped_file.h"
#include "support/try.h"

namespace galactic::bake {

template <class Archive>
void transferFields(Archive& archive, Is<DescribedShape> auto& shape) {
  archive(shape.geometry, shape.size, shape.mesh, shape.link_from_shape, shape.has_color,
          shape.color, shape.texture);
}

template <class Archive>
void transferFields(Archive& archive, Is<DescribedLink> auto& link) {
  archive(link.name, link.visuals, link.collisions);
}

template <class Archive>
void transferFields(Archive& archive, Is<DescribedJoint> auto& joint) {
  archive(joint.name, joint.parent, joint.child, joint.type, joint.parent_from_joint, joint.axis,
          joint.has_limits, joint.lower, joint.upper, joint.mimic, joint.multiplier, joint.offset);
}

template <class Archive>
void transferFields(Archive& archive, Is<RobotDescription> auto& model) {
  archive(model.name, model.links, model.joints, model.warnings);
}

template <class Archive>
void transferFields(Archive& archive, Is<LinkInertial> auto& inertial) {
  archive(inertial.link, inertial.mass, inertial.center, inertial.moments);
}

template <class Archive>
void transferFields(Archive& archive, Is<LinkSpheres> auto& link) {
  archive(link.link, link.spheres);
}

namespace {

namespace fs = std::filesystem;

/// XML trees take some tens of bytes per byte of text.
constexpr std::uint64_t kMemoryLimit = std::uint64_t{8} << 30U;

/// The parser recurses, and takes time in proportion to the depth for every element.
constexpr int kMaxNesting = 100;

/// Where the XML construct that starts with '<' at `at` ends: behind its '>'.
std::size_t endOfTag(std::string_view text, std::size_t at) {
  const auto behind = [&](std::string_view end) {
    const std::size_t found = text.find(end, at);
    return found == std::string_view::npos ? text.size() : found + end.size();
  };
  const std::string_view left = text.substr(at);
  if (left.starts_with("<!--")) return behind("-->");
  if (left.starts_with("<![CDATA[")) return behind("]]>");
  if (left.starts_with("<?")) return behind("?>");
  char quote = 0;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '>') {
      return at + 1;
    }
  }
  return text.size();
}

/// Whether elements of well-formed XML nest at most kMaxNesting deep; for other text a guess, which
/// spares the parser the worst.
bool nestsModerately(std::string_view text) {
  int depth = 0;
  for (std::size_t at = text.find('<'); at != std::string_view::npos;) {
    const std::size_t end = endOfTag(text, at);
    const char kind = at + 1 < text.size() ? text[at + 1] : ' ';
    const bool closes_itself = end >= 2 && text[end - 2] == '/';
    if (kind == '/') {
      --depth;
    } else if (kind != '!' && kind != '?' && !closes_itself) {
      ++depth;
    }
    if (depth > kMaxNesting) return false;
    at = text.find('<', end);
  }
  return true;
}

Result<std::string> readText(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    return fail(ErrorCode::kIo, path.string(), "it is a folder; give the path of a URDF file");
  }
  const std::uintmax_t size = fs::file_size(path, error);
  if (!error && size > kMaxRobotFileBytes) {
    return fail(ErrorCode::kInvalidInput, path.string(),
                fmt::format("it has {} bytes, at most {} are read; is it a URDF?", size,
                            kMaxRobotFileBytes));
  }
  ASSIGN_OR_RETURN(const auto file, MappedFile::open(path));
  const auto bytes = file.bytes();
  std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  RETURN_IF_ERROR(checkRobotText(text, path.string()));
  return text;
}

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

/// Parses a file in a child: `parse` gives a Result<T>.
template <class T, class Parse>
Result<T> parseIsolated(const fs::path& path, std::chrono::seconds time_limit, Parse parse) {
  ASSIGN_OR_RETURN(const auto text, readText(path));
  const auto work = [&](ProcessChannel& channel) {
    const TransferSink sink = [&](std::span<const std::byte> bytes) { channel.write(bytes); };
    TransferWriter writer(sink);
    const Result<T> parsed = parse(text, path.string());
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

Result<void> checkRobotText(std::string_view text, const std::string& where) {
  if (text.find('\0') != std::string_view::npos) {
    return fail(ErrorCode::kInvalidInput, where,
                "it has NUL bytes, so it is no XML text; is it a URDF?");
  }
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) {
    return fail(ErrorCode::kInvalidInput, where, "the file is empty; generate it again");
  }
  if (!nestsModerately(text)) {
    return fail(
        ErrorCode::kInvalidInput, where,
        fmt::format("its elements are nested more than {} deep; is it a URDF?", kMaxNesting));
  }
  return {};
}

Result<RobotDescription> readDescription(const fs::path& path, std::chrono::seconds time_limit) {
  return parseIsolated<RobotDescription>(path, time_limit, parseUrdf);
}

Result<std::vector<LinkInertial>> readInertials(const fs::path& path,
                                                std::chrono::seconds time_limit) {
  return parseIsolated<std::vector<LinkInertial>>(path, time_limit, parseInertials);
}

Result<std::vector<LinkSpheres>> readSrdf(const fs::path& path, std::chrono::seconds time_limit) {
  return parseIsolated<std::vector<LinkSpheres>>(path, time_limit, parseSrdf);
}

}  // namespace galactic::bake
