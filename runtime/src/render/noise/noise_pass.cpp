#include "render/noise/noise_pass.h"

#include "render/noise/noise_kernels.h"
#include "support/drawn_in.h"
#include "support/processor.h"
#include "support/random_stream.h"

namespace galactic::render {
namespace {

// Keep these draws independent of each other and of those of other sensors.
constexpr std::uint64_t kDepthSalt = 0x44657074682D3031ULL;
constexpr std::uint64_t kColorSalt = 0x436F6C6F722D3031ULL;
constexpr std::uint64_t kLightSalt = 0x4C696768742D3031ULL;

// Salts of the numbers that episodes draw from options that are ranges.
constexpr std::uint64_t kDepthDraw = 0x44657074682D4431ULL;
constexpr std::uint64_t kDropoutDraw = 0x44726F702D2D4431ULL;
constexpr std::uint64_t kColorDraw = 0x436F6C6F722D4431ULL;
constexpr std::uint64_t kLightDraw = 0x4C696768742D4431ULL;

PixelKey keyOf(std::uint64_t salt, const NoiseSource& source) {
  const EnvMoment& moment = source.moment;
  RandomStream random(moment.seed ^ salt ^ source.camera, moment.env, moment.episode, moment.step);
  const std::uint64_t low = random.next();
  const std::uint64_t high = random.next();
  return {{static_cast<std::uint32_t>(low), static_cast<std::uint32_t>(low >> 32U),
           static_cast<std::uint32_t>(high), static_cast<std::uint32_t>(high >> 32U)}};
}

/// The brightness of an episode, the same for the images of all cameras.
float gainOf(float jitter, const EnvMoment& moment) {
  RandomStream random(moment.seed ^ kLightSalt, moment.env, moment.episode, 0);
  return 1 + jitter * (2 * random.unit() - 1);
}

}  // namespace

NoisePass::NoisePass(const RenderOptions& options)
    : options_(options),
      has_avx2_(detail::hasAvx2()),
      workers_(detail::threadCount(options.threads), [this](std::size_t) { addToImages(); }) {}

void NoisePass::run(std::span<const RenderView> views, const RenderTargets& targets) noexcept {
  views_ = views;
  targets_ = targets;
  next_.store(0, std::memory_order_relaxed);
  workers_.run();
}

void NoisePass::addToImages() noexcept {
  for (std::size_t n = next_.fetch_add(1, std::memory_order_relaxed); n < views_.size();
       n = next_.fetch_add(1, std::memory_order_relaxed)) {
    addTo(n);
  }
}

void NoisePass::addTo(std::size_t image) const noexcept {
  const NoiseSource& source = views_[image].noise;
  const ImageNoise noise = episodeImageNoise(options_.noise, source);
  const std::size_t pixels = std::size_t{options_.width} * options_.height;
  if (noise.changesDepth()) {
    const DepthNoise depth{.key = keyOf(kDepthSalt, source),
                           .deviation = noise.depth_noise.most,
                           .dropped = static_cast<std::int32_t>(noise.depth_dropout.most * 0x1p24F),
                           .near = options_.near};
    const auto add = has_avx2_ ? addDepthNoiseAvx2 : addDepthNoisePortable;
    add(depth, targets_.depth.data() + image * pixels, pixels);
  }
  if (noise.changesColor()) {
    const auto channels = static_cast<std::uint32_t>(options_.color);
    const ColorNoise color{.key = keyOf(kColorSalt, source),
                           .deviation = noise.color_noise.most,
                           .gain = gainOf(noise.light_jitter.most, source.moment)};
    const auto add = has_avx2_ ? addColorNoiseAvx2 : addColorNoisePortable;
    add(color, targets_.color.data() + image * pixels * channels, channels, pixels);
  }
}

}  // namespace galactic::render

namespace galactic {

ImageNoise episodeImageNoise(const ImageNoise& noise, const NoiseSource& source) noexcept {
  const auto drawn = [&](const DrawnNumber& number, std::uint64_t salt) {
    return drawnIn(source.moment, number, salt);
  };
  return {.depth_noise = drawn(noise.depth_noise, render::kDepthDraw ^ source.camera),
          .depth_dropout = drawn(noise.depth_dropout, render::kDropoutDraw ^ source.camera),
          .color_noise = drawn(noise.color_noise, render::kColorDraw ^ source.camera),
          .light_jitter = drawn(noise.light_jitter, render::kLightDraw)};
}

}  // namespace galactic
