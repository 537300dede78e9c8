#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "galactic/pack_reference.h"
#include "galactic/world.h"
#include "pack_tool/pack_description.h"
#include "pack_tool/verbs.h"

namespace galactic::pack_tool {

namespace {

/// What became of one pack. An entry of the report has its file and whether it is ok, then kind and
/// size, or exit code, place and message of the offence.
struct Checked {
  Json entry;
  int exit_code = kExitOk;
};

/// Checks packs and prints a line for each.
class PackChecker {
 public:
  PackChecker(OutputForm form, const Console& console) : form_(form), console_(console) {}

  [[nodiscard]] Checked check(const std::filesystem::path& path) const {
    const auto pack = PackFile::open(path, Trust::kVerify);
    if (!pack) return bad(path.string(), pack.error());
    if (pack->kind() == PackKind::kWorld) return checkWorld(*pack);
    return good(*pack);
  }

 private:
  [[nodiscard]] Checked good(const PackFile& pack) const {
    if (form_ == OutputForm::kText) {
      console_.out << fmt::format("{}: ok\n", printable(pack.where()));
    }
    return {{{"file", pack.where()},
             {"ok", true},
             {"kind", packKindName(pack.kind())},
             {"bytes", pack.bytes().size()}}};
  }

  [[nodiscard]] Checked bad(const std::string& file, const Error& error) const {
    const int exit_code = reportError(console_, error);
    return {{{"file", file},
             {"ok", false},
             {"exit_code", exit_code},
             {"where", error.where},
             {"message", error.message}},
            exit_code};
  }

  /// Each of the listed packs, then, where all are good, whether they fit together.
  [[nodiscard]] Checked checkWorld(const PackFile& world) const {
    const auto references = packReferences(world);
    if (!references) return bad(world.where(), references.error());
    Json entries = Json::array();
    std::vector<PackFile> packs;
    packs.reserve(references->size());
    int worst = kExitOk;
    for (const PackReference& reference : *references) {
      Result<PackFile> pack = openReference(world, reference);
      Checked one = pack ? good(*pack) : bad(pathOf(reference, world).string(), pack.error());
      worst = worseExit(worst, one.exit_code);
      entries.push_back(std::move(one.entry));
      if (pack) packs.push_back(std::move(*pack));
    }
    Checked checked = verdict(world, std::move(packs), references->size());
    checked.exit_code = worseExit(worst, checked.exit_code);
    checked.entry["packs"] = std::move(entries);
    return checked;
  }

  [[nodiscard]] Checked verdict(const PackFile& world, std::vector<PackFile> good_packs,
                                std::size_t listed) const {
    if (good_packs.size() < listed) {
      return bad(world.where(), {ErrorCode::kInvalidInput, world.where(),
                                 fmt::format("lists {} packs, {} of them are bad; see above",
                                             listed, listed - good_packs.size())});
    }
    const auto fits = checkTogether(std::move(good_packs));
    return fits ? good(world) : bad(world.where(), fits.error());
  }

  OutputForm form_;
  const Console& console_;
};

}  // namespace

int runCheck(const CheckOptions& options, const Console& console) {
  int exit_code = kExitOk;
  Json report = Json::array();
  for (const auto& path : options.packs) {
    Checked checked = PackChecker(options.form, console).check(path);
    exit_code = worseExit(exit_code, checked.exit_code);
    report.push_back(std::move(checked.entry));
  }
  if (options.form == OutputForm::kJson) console.out << jsonText(report);
  return exit_code;
}

}  // namespace galactic::pack_tool
