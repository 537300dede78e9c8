#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "pack_tool/describe/asset_text.h"
#include "pack_tool/describe/text_parts.h"
#include "pack_tool/support/text_table.h"
#include "support/text/counted.h"

namespace galactic::pack_tool {

namespace {

std::string percentOf(const Json& part, const Json& whole) {
  const auto all = whole.get<std::uint64_t>();
  if (all == 0) return "0 %";
  return fmt::format(
      "{:.0f} %", 100 * static_cast<double>(part.get<std::uint64_t>()) / static_cast<double>(all));
}

std::string millimeterOf(const Json& length) {
  return fmt::format("{:.2f}", 1e3 * numberOf(length));
}

/// "3 of 512 texels (rgba8), 1 of 256 texels (bc1)", largest first.
std::string textureSizes(const Json& textures) {
  std::map<std::pair<std::uint32_t, std::string>, std::size_t, std::greater<>> counts;
  for (const Json& texture : textures) {
    ++counts[{texture.at("size").get<std::uint32_t>(), textOf(texture.at("format"))}];
  }
  std::string text;
  for (const auto& [kind, count] : counts) {
    text += fmt::format("{}{} of {} texels ({})", text.empty() ? "" : ", ", count, kind.first,
                        kind.second);
  }
  return text;
}

std::string texturesText(const Json& render) {
  const Json& textures = render.at("textures");
  if (textures.empty()) return "none";
  const auto shared = std::ranges::count_if(
      textures, [](const Json& texture) { return !texture.at("shared").is_null(); });
  return fmt::format("{}, {} bytes: {}{}", textures.size(), countOf(render.at("texture_bytes")),
                     textureSizes(textures),
                     shared == 0 ? "" : fmt::format("; {} in texture packs", shared));
}

std::string appearanceText(const Json& render) {
  const auto cut_out = std::ranges::count_if(render.at("materials"), [](const Json& material) {
    return numberOf(material.at("alpha_cutoff")) > 0;
  });
  std::string text =
      labeled("materials",
              fmt::format("{}, {} with a cut-out shape; {}", render.at("materials").size(), cut_out,
                          render.at("colored").get<bool>() ? "vertices have colors"
                                                           : "vertices have no colors"));
  text += labeled("textures", texturesText(render));
  return text + labeled("semantics", counted(render.at("semantics").size(), "name"));
}

std::string modelsText(const Json& models) {
  TextTable table(4);
  table.add({"model", "clusters", "two-sided", "vertices", "triangles", "of", "error (mm)"});
  for (const Json& model : models) {
    table.add({textOf(model.at("name")), countOf(model.at("clusters")),
               percentOf(model.at("two_sided_clusters"), model.at("clusters")),
               countOf(model.at("vertices")), countOf(model.at("triangles")),
               countOf(model.at("source_triangles")), millimeterOf(model.at("largest_error"))});
  }
  return table.text();
}

}  // namespace

std::string renderMeshesText(const Json& render) {
  if (render.is_null()) {
    return labeled("render", "no render meshes: nothing to draw in batches, nothing textured");
  }
  std::string text = labeled(
      "render", fmt::format("{}, {} ({} two-sided), {}, {} bytes",
                            counted(render.at("models").size(), "model"),
                            countedOf(render.at("clusters"), "cluster"),
                            percentOf(render.at("two_sided_clusters"), render.at("clusters")),
                            countedOf(render.at("vertices"), "vertex"),
                            countOf(render.at("geometry_bytes"))));
  text +=
      labeled("", fmt::format("{} of {}, moved by at most {} mm", countOf(render.at("triangles")),
                              countedOf(render.at("source_triangles"), "triangle"),
                              millimeterOf(render.at("largest_error"))));
  text += appearanceText(render);
  if (render.at("models").size() > 1) text += modelsText(render.at("models"));
  return text;
}

std::string textureText(const Json& texture) {
  return labeled("texture", fmt::format("{}, {} texels ({}), {} bytes, XXH3-128 {}",
                                        textOf(texture.at("name")), countOf(texture.at("size")),
                                        textOf(texture.at("format")), countOf(texture.at("bytes")),
                                        textOf(texture.at("xxh3_128"))));
}

}  // namespace galactic::pack_tool
