#include "pack_tool/report/html_page.h"

#include <fmt/format.h>

#include <string_view>

#include "pack_tool/describe/info_text.h"
#include "pack_tool/support/xml_text.h"
#include "support/text/counted.h"
#include "view/page_data.h"

namespace galactic::pack_tool {
namespace {

constexpr std::string_view kStyle = R"css(
body { font: 15px/1.45 system-ui, sans-serif; margin: 2rem auto; max-width: 76rem; padding: 0 1rem;
       color: #202024; background: #fff; }
table { border-collapse: collapse; width: 100%; }
th, td { text-align: left; padding: .25rem .75rem .25rem 0; border-bottom: 1px solid #ddd; }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; }
section { margin-top: 2.5rem; border-top: 2px solid #202024; }
.pictures { display: flex; flex-wrap: wrap; gap: 1rem; align-items: flex-start; }
figure { margin: 0; } figcaption { color: #666; }
img { max-width: 100%; height: auto; border: 1px solid #ddd; }
pre { overflow-x: auto; background: #f6f6f7; padding: .75rem; }
.warnings { color: #8a4b00; }
)css";

std::string textAt(const Json& json, const char* key) {
  return xmlEscaped(json.at(key).get<std::string>());
}

const Json& warningsOf(const PackEntry& pack) {
  return pack.description.at("provenance").at("warnings");
}

std::string row(std::size_t number, const PackEntry& pack) {
  return fmt::format(
      "<tr><td><a href=\"#pack{}\">{}</a></td><td>{}</td><td class=\"number\">{:.2f}</td>"
      "<td class=\"number\">{}</td></tr>\n",
      number, textAt(pack.description, "file"), textAt(pack.description, "kind"),
      pack.description.at("bytes").get<double>() / 1e6, warningsOf(pack).size());
}

std::string picture(const Thumbnail& thumbnail) {
  return fmt::format(
      "<figure><img width=\"{}\" height=\"{}\" alt=\"{}\" src=\"data:image/png;base64,{}\">"
      "<figcaption>{}</figcaption></figure>\n",
      thumbnail.width, thumbnail.height, xmlEscaped(thumbnail.caption), base64(thumbnail.png),
      xmlEscaped(thumbnail.caption));
}

std::string section(std::size_t number, const PackEntry& pack) {
  std::string text = fmt::format("<section id=\"pack{}\">\n<h2>{}</h2>\n", number,
                                 textAt(pack.description, "file"));
  if (!warningsOf(pack).empty()) {
    text += "<ul class=\"warnings\">\n";
    for (const Json& warning : warningsOf(pack)) {
      text += "<li>" + xmlEscaped(warning.get<std::string>()) + "</li>\n";
    }
    text += "</ul>\n";
  }
  text += "<div class=\"pictures\">\n";
  for (const Thumbnail& thumbnail : pack.thumbnails) text += picture(thumbnail);
  text += "</div>\n<details><summary>What is in it</summary>\n<pre>";
  return text + xmlEscaped(infoText(pack.description)) + "</pre></details>\n</section>\n";
}

}  // namespace

std::string htmlPage(const std::string& title, const std::vector<PackEntry>& packs,
                     const ListedTextures& textures) {
  double bytes = 0;
  std::size_t warnings = 0;
  std::string rows;
  std::string sections;
  for (std::size_t n = 0; n < packs.size(); ++n) {
    bytes += packs[n].description.at("bytes").get<double>();
    warnings += warningsOf(packs[n]).size();
    rows += row(n, packs[n]);
    sections += section(n, packs[n]);
  }
  std::string also;
  if (textures.count > 0) {
    also = fmt::format("and {}, {:.2f} MB; ", counted(textures.count, "texture"),
                       static_cast<double>(textures.bytes) / 1e6);
  }
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n<title>{0}</title>\n"
      "<style>{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n"
      "<p>{2}, {3:.2f} MB, {7}{4}</p>\n"
      "<table>\n<tr><th>pack</th><th>kind</th><th class=\"number\">MB</th>"
      "<th class=\"number\">warnings</th></tr>\n{5}</table>\n{6}</body>\n</html>\n",
      xmlEscaped(title), kStyle, counted(packs.size(), "pack"), bytes / 1e6,
      counted(warnings, "warning"), rows, sections, also);
}

}  // namespace galactic::pack_tool
