#include "robot_description/description_reader.h"

#include <fmt/format.h>

#include <system_error>

#include "robot_description/mjcf/mjcf_reader.h"
#include "robot_description/urdf/urdf_reader.h"
#include "support/files/mapped_file.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// Where the XML construct that starts with '<' at `at` ends: one past its '>'.
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

/// Whether elements of well-formed XML nest at most kMaxXmlNesting deep. For other text this is a
/// guess, which spares the parser the worst cases.
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
    if (depth > kMaxXmlNesting) return false;
    at = text.find('<', end);
  }
  return true;
}

}  // namespace

Result<void> checkRobotText(std::string_view text, const std::string& where) {
  if (text.find('\0') != std::string_view::npos) {
    return fail(ErrorCode::kInvalidInput, where,
                "it has NUL bytes, so it is no XML text; is it a URDF or an MJCF?");
  }
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) {
    return fail(ErrorCode::kInvalidInput, where, "the file is empty; generate it again");
  }
  if (!nestsModerately(text)) {
    return fail(ErrorCode::kInvalidInput, where,
                fmt::format("its elements are nested more than {} deep; is it a URDF or an MJCF?",
                            kMaxXmlNesting));
  }
  return {};
}

Result<std::string> readRobotText(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    return fail(ErrorCode::kIo, path.string(),
                "it is a folder; give the path of a robot's file (URDF or MJCF)");
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size > kMaxRobotFileBytes) {
    return fail(ErrorCode::kInvalidInput, path.string(),
                fmt::format("it has {} bytes, at most {} are read; is it a URDF or an MJCF?", size,
                            kMaxRobotFileBytes));
  }
  ASSIGN_OR_RETURN(const auto file, MappedFile::open(path));
  const auto bytes = file.bytes();
  std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  RETURN_IF_ERROR(checkRobotText(text, path.string()));
  return text;
}

std::string_view rootElementOf(std::string_view text) {
  for (std::size_t at = text.find('<'); at != std::string_view::npos; at = text.find('<', at)) {
    const std::string_view left = text.substr(at + 1);
    if (left.starts_with('!') || left.starts_with('?')) {
      at = endOfTag(text, at);
      continue;
    }
    return left.substr(0, left.find_first_of(" \t\r\n/>"));
  }
  return {};
}

Result<RobotDescription> parseDescription(const std::string& text,
                                          const std::filesystem::path& path,
                                          const DescriptionRequest& request) {
  const std::string_view root = rootElementOf(text);
  if (root == "mujoco") return parseMjcf(text, path, request);
  if (root == "mujocoinclude") {
    return fail(ErrorCode::kInvalidInput, path.string(),
                "it is a part of an MJCF, <mujocoinclude>; give the file that includes it");
  }
  return parseUrdf(text, path.string(), request.part);
}

}  // namespace galactic::bake
