#include "pack_tool/check/finding.h"

#include <algorithm>
#include <array>

namespace galactic::pack_tool {

namespace {

constexpr auto kIo = ErrorCode::kIo;
constexpr auto kInvalid = ErrorCode::kInvalidInput;
constexpr auto kUnsupported = ErrorCode::kUnsupported;

constexpr std::array kKinds{
    FindingKind{"file/not-regular", kIo, "is not a regular file"},
    FindingKind{"file/unreadable", kIo, "cannot "},
    FindingKind{"file/no-packs", kInvalid, "has no files *.pack"},
    FindingKind{"pack/truncated", kInvalid, "bytes, a pack has at least"},
    FindingKind{"pack/not-a-pack", kInvalid, "it is not a pack; bake one"},
    FindingKind{"pack/version-old", kUnsupported, "bake it again"},
    FindingKind{"pack/version-new", kUnsupported, "update galactic"},
    FindingKind{"pack/kind", kInvalid, "has the unknown kind"},
    FindingKind{"pack/size", kInvalid, "payload bytes but has"},
    FindingKind{"pack/reserved", kInvalid, "has reserved header bytes"},
    FindingKind{"pack/alignment", kInvalid, "lies at an address"},
    FindingKind{"pack/too-large", kInvalid, "has a payload of"},
    FindingKind{"pack/identifier", kInvalid, "does not carry the identifier"},
    FindingKind{"pack/hash", kInvalid, "payload hash is"},
    FindingKind{"pack/structure", kInvalid, "is not a well-formed FlatBuffer"},
    FindingKind{"pack/asset", kInvalid, "has type"},
    FindingKind{"world/missing-pack", kInvalid, "which is missing; put it there"},
    FindingKind{"world/other-pack", kInvalid, "it is not the pack that was linked"},
    FindingKind{"world/bad-pack", kInvalid, "of them are bad; see"},
    FindingKind{"world/repeated-name", kInvalid, "names have to be unique in a world"},
    FindingKind{"world/repeated-part", kInvalid, "a world has one, leave one out"},
    FindingKind{"world/policy", kInvalid, "is a policy, which cannot be part of a world"},
    FindingKind{"world/nested", kInvalid, "is a world pack among others"},
    FindingKind{"world/missing-part", kInvalid, "give a pack of one, too"},
    FindingKind{"world/other-radii", kInvalid, "was baked for the radii"},
    FindingKind{"world/incomplete-robot", kInvalid, "wanted a robot to simulate"},
    FindingKind{"world/other-robot", kInvalid, "give the robot that the episodes were made for"},
    FindingKind{"world/unknown-scene", kInvalid, "scenes; add its pack"},
    FindingKind{"world/unknown-object", kInvalid, "objects; add its pack"},
};

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

std::span<const FindingKind> findingKinds() { return kKinds; }

std::string findingCode(const Error& error, std::string_view file) {
  if (error.code == ErrorCode::kInternal) return "internal/error";
  const auto kind = std::find_if(kKinds.begin(), kKinds.end(), [&error](const FindingKind& one) {
    return one.error == error.code && error.message.find(one.fragment) != std::string::npos;
  });
  constexpr std::string_view kBeforeElement = ": ";
  std::string_view element = error.where;
  if (element.starts_with(file)) element.remove_prefix(file.size());
  const bool has_element =
      element.starts_with(kBeforeElement) && isElement(element.substr(kBeforeElement.size()));
  // Only worlds and the asset's type have kinds with an element; what values say is no kind.
  const bool by_kind = kind != kKinds.end() && (!has_element || kind->code.starts_with("world/") ||
                                                kind->code == "pack/asset");
  if (by_kind) return std::string(kind->code);
  if (has_element) return codeOfElement(element.substr(kBeforeElement.size()));
  return "pack/other";
}

}  // namespace galactic::pack_tool
