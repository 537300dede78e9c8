#include "pack_tool/check/junit.h"

#include <fmt/format.h>

#include "pack_tool/support/xml_text.h"

namespace galactic::pack_tool {

namespace {

struct Totals {
  std::size_t tests = 0;
  std::size_t failures = 0;
};

/// Adds the test cases of `pack`; `world` is the pack that lists it, if any.
void addCases(const CheckedPack& pack, const std::string& world, std::string& xml, Totals& totals) {
  for (const CheckedPack& listed : pack.listed) addCases(listed, pack.file, xml, totals);
  ++totals.tests;
  const std::string owner = world.empty() ? "packs" : world;
  xml += fmt::format("    <testcase classname=\"{}\" name=\"{}\"", xmlEscaped(owner),
                     xmlEscaped(pack.file));
  if (!pack.finding) {
    xml += "/>\n";
    return;
  }
  ++totals.failures;
  const auto& [code, error] = *pack.finding;
  xml += fmt::format(
      ">\n      <failure type=\"{}\" message=\"{}\">{}: {} [{}]</failure>\n    </testcase>\n",
      xmlEscaped(code), xmlEscaped(error.message), xmlEscaped(error.where),
      xmlEscaped(error.message), xmlEscaped(code));
}

}  // namespace

std::string junitText(const std::vector<CheckedPack>& packs) {
  std::string cases;
  Totals totals;
  for (const CheckedPack& pack : packs) addCases(pack, "", cases, totals);
  const std::string counts =
      fmt::format("name=\"galactic-pack check\" tests=\"{}\" failures=\"{}\" errors=\"0\"",
                  totals.tests, totals.failures);
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {}>\n  <testsuite {}>\n{}  "
      "</testsuite>\n</testsuites>\n",
      counts, counts, cases);
}

}  // namespace galactic::pack_tool
