#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "pack_tool/pack_description.h"
#include "pack_tool/verbs.h"

namespace galactic::pack_tool {

int runCheck(const CheckOptions& options, const Console& console) {
  int exit_code = kExitOk;
  Json report = Json::array();
  for (const auto& path : options.packs) {
    const auto pack = PackFile::open(path, Trust::kVerify);
    Json entry;
    entry["file"] = path.string();
    entry["ok"] = pack.has_value();
    if (pack) {
      entry["kind"] = packKindName(pack->kind());
      entry["bytes"] = pack->bytes().size();
      if (options.form == OutputForm::kText) {
        console.out << fmt::format("{}: ok\n", printable(path.string()));
      }
    } else {
      entry["exit_code"] = static_cast<int>(pack.error().code);
      entry["where"] = pack.error().where;
      entry["message"] = pack.error().message;
      exit_code = worseExit(exit_code, reportError(console, pack.error()));
    }
    report.push_back(std::move(entry));
  }
  if (options.form == OutputForm::kJson) console.out << jsonText(report);
  return exit_code;
}

}  // namespace galactic::pack_tool
