#include "pack_tool/info_text.h"
#include "pack_tool/pack_description.h"
#include "pack_tool/verbs.h"

namespace galactic::pack_tool {

int runInfo(const InfoOptions& options, const Console& console) {
  int exit_code = kExitOk;
  Json all = Json::array();
  for (const auto& path : options.packs) {
    const auto pack = PackFile::open(path, options.trust);
    if (!pack) {
      exit_code = worseExit(exit_code, reportError(console, pack.error()));
      continue;
    }
    Json description = describePack(*pack);
    if (options.form == OutputForm::kText) {
      console.out << (all.empty() ? "" : "\n") << infoText(description);
    }
    all.push_back(std::move(description));
  }
  if (options.form == OutputForm::kJson) console.out << jsonText(all);
  return exit_code;
}

}  // namespace galactic::pack_tool
