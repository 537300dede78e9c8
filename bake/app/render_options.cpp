#include <fmt/format.h>

#include "galactic/number_text.h"
#include "option_groups.h"
#include "option_values.h"

namespace galactic::bake {
namespace {

/// How far a surface may move, metres: scenes are seen from farther off than what is handled.
constexpr double kSceneError = 0.005;
constexpr double kHandledError = 0.002;

const std::map<std::string, TexelFormat>& formatNames() {
  static const std::map<std::string, TexelFormat> names{{"rgba8", TexelFormat::kRgba8},
                                                        {"bc1", TexelFormat::kBc1}};
  return names;
}

const std::map<std::string, Lighting>& lightingNames() {
  static const std::map<std::string, Lighting> names{
      {"auto", Lighting::kAuto}, {"all", Lighting::kAll}, {"none", Lighting::kNone}};
  return names;
}

}  // namespace

void RenderMeshOptions::addTo(CLI::App& app, BakeCommand& command) {
  app.add_flag("--no-render-meshes", none_, "Leave out what is drawn: a pack for physics alone");
  app.add_option("--render-error", error_,
                 "How far simplification may move a surface (default: 0.005 of scenes, else 0.002)")
      ->type_name("METRES");
  app.add_option("--texture-size", command.render.textures.largest,
                 "Longest edge of a texture, texels: a power of two (default: 512)")
      ->check(wholeCheck(1, 4096))
      ->check(CLI::IsMember({1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096}))
      ->option_text("1..4096");
  app.add_option("--texture-format", command.render.textures.format,
                 "bc1: an eighth of the size, for graphics processors; opaque textures only")
      ->transform(CLI::CheckedTransformer(formatNames()))
      ->option_text("rgba8|bc1");
  app.add_option("--lighting", command.render.meshes.lighting,
                 "What is shaded by its place and direction: all, what has no light of its own "
                 "(auto, the default), or nothing (none)")
      ->transform(CLI::CheckedTransformer(lightingNames()))
      ->option_text("auto|all|none");
}

Result<void> RenderMeshOptions::understand(BakeCommand& command) const {
  RenderOptions& render = command.render;
  render.wanted = !none_;
  render.meshes.jobs = command.jobs;
  render.textures.jobs = command.jobs;
  const bool is_handled = command.kind == AssetKind::kObject || command.kind == AssetKind::kRobot;
  render.meshes.error = is_handled ? kHandledError : kSceneError;
  if (error_.empty()) return {};
  const auto error = parseExactly(error_, "--render-error", 1);
  if (!error) return tl::unexpected(error.error());
  if (!((*error)[0] >= 0)) {
    return fail(ErrorCode::kInvalidInput, "--render-error",
                fmt::format("is {}, wanted metres, 0 or more", error_));
  }
  render.meshes.error = (*error)[0];
  return {};
}

void RenderMeshOptions::remember(BakeCommand& command) const {
  if (!command.render.wanted) return command.remember("render-meshes", "no");
  command.remember("render-error", fmt::format("{}", command.render.meshes.error));
  command.remember("texture-size", std::to_string(command.render.textures.largest));
  command.remember("texture-format", nameOf(formatNames(), command.render.textures.format));
  command.remember("lighting", nameOf(lightingNames(), command.render.meshes.lighting));
}

}  // namespace galactic::bake
