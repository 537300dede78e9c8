#include "robot_description/mjcf/included_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <system_error>
#include <utility>

#include "import/source_files.h"
#include "robot_description/description_reader.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// Replaces <include> elements with the content of the files.
class Includer {
 public:
  Includer(const fs::path& path, bool allow_outside, WholeMjcf& whole)
      : path_(path), folder_(path.parent_path()), allow_outside_(allow_outside), whole_(whole) {}

  /// Expands the content of `element`, which is in a file in `folder`, `depth` elements deep.
  Result<void> expand(XmlElement& element, const fs::path& folder, int depth) {
    if (depth > kMaxXmlNesting) {
      return fail(ErrorCode::kInvalidInput, element.place,
                  fmt::format("with what is included, elements are nested more than {} deep; is it "
                              "an MJCF?",
                              kMaxXmlNesting));
    }
    std::vector<XmlElement> children;
    for (XmlElement& child : element.children) {
      if (child.name != "include") {
        RETURN_IF_ERROR(expand(child, folder, depth + 1));
        children.push_back(std::move(child));
        continue;
      }
      ASSIGN_OR_RETURN(auto content, contentOf(child, folder, depth));
      std::move(content.begin(), content.end(), std::back_inserter(children));
    }
    element.children = std::move(children);
    return {};
  }

 private:
  Result<std::vector<XmlElement>> contentOf(const XmlElement& include, const fs::path& folder,
                                            int depth) {
    ASSIGN_OR_RETURN(const auto file, findFile(include, folder));
    if (std::ranges::find(whole_.included, file) != whole_.included.end() ||
        file == path_.lexically_normal()) {
      return fail(ErrorCode::kInvalidInput, include.place,
                  fmt::format("<include> names '{}', which is there already; a file is included "
                              "once",
                              nameRelativeTo(path_, file)));
    }
    if (whole_.included.size() == kMaxIncludedFiles) {
      return fail(ErrorCode::kInvalidInput, include.place,
                  fmt::format("it includes more than {} files; is it an MJCF?", kMaxIncludedFiles));
    }
    whole_.included.push_back(file);
    ASSIGN_OR_RETURN(const auto text, readRobotText(file));
    ASSIGN_OR_RETURN(auto root, parseXml(text, file.string()));
    RETURN_IF_ERROR(expand(root, file.parent_path(), depth));
    return std::move(root.children);
  }

  Result<fs::path> findFile(const XmlElement& include, const fs::path& folder) {
    const std::string* name = include.find("file");
    if (name == nullptr || name->empty()) {
      return fail(ErrorCode::kInvalidInput, include.place,
                  "<include> has no attribute 'file'; name the file");
    }
    for (const fs::path& beside : {folder, folder_}) {
      fs::path file = (beside / *name).lexically_normal();
      std::error_code ignored;
      if (!fs::is_regular_file(file, ignored)) {
        whole_.absent.push_back(std::move(file));
        continue;
      }
      if (allow_outside_ || isBelow(file, folder_ / "..")) return file;
      return fail(ErrorCode::kInvalidInput, include.place,
                  fmt::format("<include> names '{}', which lies outside of the folder above the "
                              "robot's file; move it, or give `allow-outside`",
                              *name));
    }
    return fail(ErrorCode::kIo, include.place,
                fmt::format("<include> names '{}', and there is no such file; put it beside the "
                            "robot's file, or correct the name",
                            *name));
  }

  const fs::path& path_;
  fs::path folder_;
  bool allow_outside_;
  WholeMjcf& whole_;
};

}  // namespace

Result<WholeMjcf> parseWithIncluded(const std::string& text, const fs::path& path,
                                    bool allow_outside) {
  WholeMjcf whole;
  ASSIGN_OR_RETURN(whole.root, parseXml(text, path.string()));
  RETURN_IF_ERROR(Includer(path, allow_outside, whole).expand(whole.root, path.parent_path(), 1));
  return whole;
}

}  // namespace galactic::bake
