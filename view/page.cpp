#include "view/page.h"

#include <fmt/format.h>

#include "support/try.h"
#include "view/page_run.h"

namespace galactic {
namespace {

/// A title is plain text: what could end it is left out, the data has the whole of it.
std::string titleElement(std::string_view title) {
  std::string text;
  for (const char c : title) {
    // A byte of a letter beyond ASCII is no control character.
    const bool is_plain =
        static_cast<unsigned char>(c) >= ' ' && c != '<' && c != '>' && c != '&' && c != '\x7f';
    text += is_plain ? c : '?';
  }
  return fmt::format("<title>{}</title>", text);
}

std::string chunkElement(std::string_view text) {
  return fmt::format("<script type=\"text/plain\" class=\"chunk\">{}</script>\n", text);
}

void replace(std::string& page, std::string_view mark, std::string_view text) {
  page.replace(page.find(mark), mark.size(), text);
}

}  // namespace

Result<std::string> viewPage(std::span<const PageAsset> assets, const PageRun& run,
                             const PageOptions& options) {
  JsonWriter json(JsonLayout::kCompact);
  PageData data;
  json.begin('{');
  json.text("title", options.title);
  json.text("generator", options.generator);
  AssetWriter writer(json, data, options.texture_size);
  json.begin("packs", '[');
  for (const PageAsset& asset : assets) {
    RETURN_IF_ERROR(writer.write(asset));
  }
  json.end(']');
  writer.writeTextures("textures");
  if (run.track != nullptr) writeRun(json, "run", data, run);
  json.end('}');

  // The first chunk says what the others are.
  std::string elements = chunkElement(packedText(json.take()));
  for (const std::string& chunk : data.chunks()) elements += chunkElement(chunk);
  std::string page(pageTemplate());
  replace(page, kDataMark, elements);
  replace(page, kTitleMark, titleElement(options.title));
  return page;
}

}  // namespace galactic
