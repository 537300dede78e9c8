#include "check/world_check.h"

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "check/common_check.h"
#include "check/offence.h"
#include "galactic/option_text.h"
#include "galactic/pack_header.h"

namespace galactic::detail {
namespace {

/// What is wrong with a path in a world's list; "" if nothing is.
const char* faultOf(std::string_view path) {
  if (path.empty()) return "is empty, expected the path of a pack";
  if (path.find('\0') != std::string_view::npos) {
    return "holds a zero byte, expected the path of a pack";
  }
  if (path.front() == '/')
    return "is absolute, expected a path relative to the world pack's folder";
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    const std::string_view part = path.substr(begin, end - begin);
    if (part == "..")
      return "leads upwards with \"..\", expected a path below the world pack's folder";
    if (part.empty() || part == ".")
      return "has an empty part or \".\", expected names between '/'";
    begin = end + 1;
  }
  return "";
}

Result<void> checkReference(const schema::PackReference& reference, const std::string& where) {
  Offence offence(where);
  const char* fault = faultOf(reference.path()->string_view());
  offence.require(fault[0] == '\0', "path", "{}", fault);
  std::optional<PackKind> kind = packKindOf(reference.kind()->string_view());
  // Policies do not belong to a world.
  if (kind == PackKind::kPolicy) kind.reset();
  offence.require(kind.has_value(), "kind", "is \"{}\", expected SCEN, OBJS, RBOT, EPIS or TXTR",
                  reference.kind()->string_view());
  offence.require(kind != PackKind::kWorld, "kind", "is \"WRLD\", expected no world in a world");
  offence.require(reference.bytes() > sizeof(PackHeader), "bytes",
                  "is {}, expected more than the {} of a pack's header", reference.bytes(),
                  sizeof(PackHeader));
  offence.require(reference.hash() != nullptr, "hash", "is missing, expected the file's hash");
  return offence.result();
}

/// Checks that the option is one of `known` at index `next` or later, and that its value is valid;
/// moves `next` past it.
Result<void> checkOption(const OptionText& option, std::span<const OptionText> known,
                         std::size_t& next, const std::string& where) {
  Offence offence(where);
  const auto found =
      std::ranges::find(known, option.name, [](const OptionText& one) { return one.name; });
  offence.require(found != known.end(), "name",
                  "is \"{}\", expected an option of the task, reward or robot of galactic-run",
                  option.name);
  if (offence.found()) return offence.result();
  const auto place = static_cast<std::size_t>(found - known.begin());
  offence.require(place >= next, "name",
                  "is \"{}\", expected each option once, in the order of galactic-run's table",
                  option.name);
  next = place + 1;
  SimulationOptions ignored;
  const auto fault = setOptions(std::span(&option, 1), OptionScope::kTask, ignored);
  offence.require(!fault, "value", "is \"{}\", expected {} for {}", option.value,
                  fault ? fault->wanted : "", option.name);
  return offence.result();
}

}  // namespace

Result<void> checkOptions(const flatbuffers::Vector<flatbuffers::Offset<schema::Option>>& options,
                          const std::string& field, const std::string& where) {
  const std::vector<OptionText> known = listOptions({}, OptionScope::kTask);
  Offence offence(where);
  std::size_t next = 0;
  for (flatbuffers::uoffset_t n = 0; n < options.size() && !offence.found(); ++n) {
    const schema::Option& stored = *options.Get(n);
    const OptionText option{stored.name()->str(), stored.value()->str()};
    offence.require(
        checkOption(option, known, next, fmt::format("{}.{}[{}]", offence.where(), field, n)));
  }
  return offence.result();
}

Result<void> checkWorld(const schema::World& world, const std::string& where) {
  Offence offence(where + ": world");
  const auto& packs = *world.packs();
  std::map<std::string_view, std::size_t> counts;
  for (flatbuffers::uoffset_t n = 0; n < packs.size() && !offence.found(); ++n) {
    const std::string field = fmt::format("packs[{}]", n);
    offence.require(checkReference(*packs.Get(n), offence.where() + "." + field));
    ++counts[packs.Get(n)->kind()->string_view()];
    if (n == 0) continue;
    offence.require(packs.Get(n - 1)->path()->string_view() < packs.Get(n)->path()->string_view(),
                    field + ".path",
                    "does not come after its predecessor, expected ascending paths");
  }
  offence.require(counts["RBOT"] <= 1, "packs", "has {} robots (RBOT), expected at most one",
                  counts["RBOT"]);
  offence.require(counts["EPIS"] <= 1, "packs", "has {} episode sets (EPIS), expected at most one",
                  counts["EPIS"]);
  offence.require(counts["SCEN"] >= 1, "packs", "has no scene (SCEN), expected at least one");
  if (world.task() != nullptr)
    offence.require(checkOptions(*world.task(), "task", offence.where()));
  return offence.result();
}

}  // namespace galactic::detail
