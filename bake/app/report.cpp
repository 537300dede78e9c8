#include "report.h"

#include <span>
#include <string>

#include "galactic/atomic_file.h"

namespace galactic::bake {

Json reportOf(const BakeRun& run) {
  Json json{{"tool", "galactic-bake"}, {"version", GALACTIC_VERSION}};
  json["baked"] = run.baked();
  json["failed"] = Json::array();
  for (const BakeFailure& failure : run.failures()) {
    json["failed"].push_back({{"input", failure.input.string()},
                              {"code", static_cast<int>(failure.error.code)},
                              {"where", failure.error.where},
                              {"message", failure.error.message}});
  }
  return json;
}

Result<void> writeReport(const std::filesystem::path& path, const BakeRun& run) {
  const std::string text = reportOf(run).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  return writeFileAtomically(path, {std::as_bytes(std::span(text))});
}

}  // namespace galactic::bake
