#include "pack_tool/check/finding.h"

namespace galactic::pack_tool {

namespace {

bool isElement(std::string_view text) {
  constexpr std::string_view kCharacters = "abcdefghijklmnopqrstuvwxyz_0123456789.[]";
  return !text.empty() && text.find_first_not_of(kCharacters) == std::string_view::npos;
}

/// "scene.column_grids[1].cells[7]" as "scene/column_grids.cells".
std::string codeOfElement(std::string_view element) {
  std::string code;
  int depth = 0;
  for (const char c : element) {
    depth += c == '[' ? 1 : 0;
    if (depth == 0) code += c;
    depth -= c == ']' ? 1 : 0;
  }
  const std::size_t dot = code.find('.');
  if (dot == std::string::npos) return "pack/" + code;
  code[dot] = '/';
  return code;
}

}  // namespace

std::string findingCode(const Error& error, std::string_view file) {
  if (error.code == ErrorCode::kInternal) return "internal/error";
  if (!error.name.empty()) return std::string(error.name);
  constexpr std::string_view kBeforeElement = ": ";
  std::string_view element = error.where;
  if (element.starts_with(file)) element.remove_prefix(file.size());
  const bool has_element =
      element.starts_with(kBeforeElement) && isElement(element.substr(kBeforeElement.size()));
  return has_element ? codeOfElement(element.substr(kBeforeElement.size())) : "pack/other";
}

}  // namespace galactic::pack_tool
