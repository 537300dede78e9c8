#include "pack_tool/describe/info_text.h"
#include "pack_tool/describe/pack_description.h"
#include "pack_tool/verbs/verbs.h"

namespace galactic::pack_tool {

int runInfo(const InfoOptions& options, const Console& console) {
  int exit_code = kExitOk;
  bool first = true;
  Json all = Json::array();
  for (const auto& path : options.packs) {
    const auto pack = PackFile::open(path, options.trust);
    if (!pack) {
      exit_code = worseExit(exit_code, reportError(console, pack.error()));
      continue;
    }
    if (options.form == OutputForm::kText) {
      console.out << (first ? "" : "\n") << infoText(describePack(*pack, Detail::kSummary));
    } else {
      all.push_back(describePack(*pack));
    }
    first = false;
  }
  if (options.form == OutputForm::kJson) console.out << jsonText(all);
  return exit_code;
}

}  // namespace galactic::pack_tool
