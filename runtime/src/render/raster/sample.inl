// Colors of a vector of pixels from the records of their triangles: texture coordinates by
// perspective, the mip level whose texels come closest to one per pixel, bilinear between four
// texels of it, as GL_LINEAR_MIPMAP_NEAREST does; colors are weighed as they are stored (sRGB), in
// eighths of bits.
namespace galactic::render {
namespace {

/// Where some pixels lie on their textures.
struct TexturePlaces {
  /// Texels of the largest level.
  Lanes u, v;
  /// Square of the most texels per pixel.
  Lanes squared_rate;
  IntLanes texels, kind;
};

/// Weights for blend(), alike in both halves, from shares within [0, 1].
GALACTIC_EVERYWHERE inline IntLanes blendWeight(Lanes share) {
  const IntLanes weight = toInt(share * spread(256.0F) + spread(0.5F));
  return weight | weight << 16;
}

struct FourTexels {
  IntLanes upper_left, upper_right, lower_left, lower_right;
};

GALACTIC_EVERYWHERE inline IntLanes bilinear(const FourTexels& t, Lanes share_right,
                                             Lanes share_down) {
  const IntLanes whole = spread(0x01000100);
  const IntLanes right = blendWeight(share_right);
  const IntLanes down = blendWeight(share_down);
  const auto right_weight = as<ShortLanes>(right);
  const auto left_weight = as<ShortLanes>(whole - right);
  const auto down_weight = as<ShortLanes>(down);
  const auto up_weight = as<ShortLanes>(whole - down);
  const auto even = [](IntLanes v) { return as<ShortLanes>(v & 0x00FF00FF); };
  const auto odd = [](IntLanes v) { return as<ShortLanes>(v) >> 8; };
  const ShortLanes low =
      blend(blend(even(t.upper_left), even(t.upper_right), right_weight, left_weight),
            blend(even(t.lower_left), even(t.lower_right), right_weight, left_weight), down_weight,
            up_weight);
  const ShortLanes high =
      blend(blend(odd(t.upper_left), odd(t.upper_right), right_weight, left_weight),
            blend(odd(t.lower_left), odd(t.lower_right), right_weight, left_weight), down_weight,
            up_weight);
  return as<IntLanes>(low | high << 8);
}

/// Texels in the levels from one of edge 2^n down to the last.
GALACTIC_EVERYWHERE inline IntLanes texelsDownFrom(IntLanes n) {
  return spread(0x55555555) & ((spread(4) << (n + n)) - spread(1));
}

/// Towards minus infinity.
GALACTIC_EVERYWHERE inline IntLanes floorOf(Lanes v) {
  const IntLanes whole = toInt(v);
  return whole + (toFloat(whole) > v);
}

/// Levels of textures.
struct Levels {
  /// From texels of the largest level to those of this one.
  Lanes scale;
  /// The number of the first texel, log2 of the edge, and the edge less one.
  IntLanes first, log_edge, wrap;
};

/// The level with about one texel per pixel, of textures whose edges are 2^size.
GALACTIC_EVERYWHERE inline IntLanes levelOf(Lanes squared_rate, IntLanes size) {
  // log4 of the doubled square, rounded down: changes half way between two levels.
  const IntLanes exponent = as<IntLanes>(squared_rate * spread(2.0F)) >> 23;
  return lesser(greater((exponent - spread(127)) >> 1, spread(0)), size);
}

/// The same level for all.
GALACTIC_EVERYWHERE inline Levels oneLevel(std::int32_t level, std::int32_t size, IntLanes texels) {
  const auto texels_down_from = [](std::int32_t n) { return 0x55555555U & ((4U << (2 * n)) - 1U); };
  const std::int32_t log_edge = size - level;
  const std::uint32_t before = texels_down_from(size) - texels_down_from(log_edge);
  return {spread(as<float>((127 - level) << 23)),
          texels + spread(static_cast<std::int32_t>(before)), spread(log_edge),
          spread((1 << log_edge) - 1)};
}

GALACTIC_EVERYWHERE inline Levels levelsAt(IntLanes level, IntLanes size, IntLanes texels) {
  const IntLanes log_edge = size - level;
  return {as<Lanes>((spread(127) - level) << 23),
          texels + (texelsDownFrom(size) - texelsDownFrom(log_edge)), log_edge,
          (spread(1) << log_edge) - spread(1)};
}

/// A place in one level of a texture: the four texels around it and the shares of the latter ones.
struct LevelPlace {
  FourTexels at;
  Lanes share_right, share_down;
  /// Where the right texels do not follow the left ones in memory.
  IntLanes wraps;
};

GALACTIC_EVERYWHERE inline LevelPlace placeInLevel(const TexturePlaces& places,
                                                   const Levels& level) {
  constexpr float kFarthest = 1 << 22;
  const Lanes u = clampTo(places.u * level.scale - spread(0.5F), -kFarthest, kFarthest);
  const Lanes v = clampTo(places.v * level.scale - spread(0.5F), -kFarthest, kFarthest);
  const IntLanes left = floorOf(u);
  const IntLanes upper = floorOf(v);
  const IntLanes row0 = level.first + ((upper & level.wrap) << level.log_edge);
  const IntLanes row1 = level.first + (((upper + spread(1)) & level.wrap) << level.log_edge);
  const IntLanes column0 = left & level.wrap;
  const IntLanes column1 = (left + spread(1)) & level.wrap;
  return {{row0 + column0, row0 + column1, row1 + column0, row1 + column1},
          u - toFloat(left),
          v - toFloat(upper),
          column0 == level.wrap};
}

GALACTIC_EVERYWHERE inline const std::int32_t* texelBase(const PaneTask& task,
                                                         std::int32_t number) {
  return reinterpret_cast<const std::int32_t*>(task.texel_bases[number]);
}

/// Texels of one base. Most left texels have their right ones behind them: both are read at once,
/// which halves the work where lanes are many. `wraps`: for one lane or more that is not so.
[[gnu::always_inline]] GALACTIC_EVERYWHERE inline FourTexels readTexels(const std::int32_t* from,
                                                                        const FourTexels& at,
                                                                        bool wraps) {
  if (kLanes > 1 && !wraps) {
    const Pair<IntLanes> upper = gatherNeighbors(from, at.upper_left);
    const Pair<IntLanes> lower = gatherNeighbors(from, at.lower_left);
    return {upper.first, upper.second, lower.first, lower.second};
  }
  return {gather(from, at.upper_left), gather(from, at.upper_right), gather(from, at.lower_left),
          gather(from, at.lower_right)};
}

GALACTIC_EVERYWHERE inline FourTexels masked(const FourTexels& t, IntLanes mask) {
  return {t.upper_left & mask, t.upper_right & mask, t.lower_left & mask, t.lower_right & mask};
}

/// Where the texels of some pixels lie, and what decides how they are read: with these numbers at
/// hand, reading waits for nothing.
struct SurfacePlace {
  /// Not set where no lane has a texture.
  LevelPlace place;
  /// Of the records: see kTexels and kKind.
  IntLanes texels, kind;
  /// Bit n: lane n has a texture; it has one of another base than the first of them.
  unsigned textured, others;
  /// Of the first one.
  std::int32_t base;
  bool wraps;
};

GALACTIC_EVERYWHERE inline IntLanes baseOf(IntLanes kind) { return (kind >> 8) & 0x3FFFFF; }

/// `places`: what gives them where a lane has a texture. Lanes without a triangle are flat.
template <class Places>
GALACTIC_EVERYWHERE inline void placeSurface(IntLanes texels, IntLanes kind, const Places& places,
                                             SurfacePlace& surface) {
  surface.texels = texels;
  surface.kind = kind;
  const IntLanes flat = (kind & 0xFF) == spread(static_cast<std::int32_t>(kFlatSurface));
  surface.textured = ~signBits(flat) & kAllLanes;
  if (surface.textured == 0) return;
  const IntLanes size = pick(flat, spread(0), kind & 0xFF);
  const TexturePlaces found = places();
  LevelPlace& place = surface.place;
  place = placeInLevel(found, levelsAt(levelOf(found.squared_rate, size), size, texels));
  place.at = masked(place.at, ~flat);
  surface.wraps = (signBits(place.wraps) & surface.textured) != 0;
  const IntLanes first = laneOf(baseOf(kind), lowestBit(surface.textured));
  surface.base = first[0];
  surface.others = signBits(baseOf(kind) != first) & surface.textured;
}

/// Texels of several bases.
[[gnu::noinline]] GALACTIC_EVERYWHERE inline FourTexels readMixed(const PaneTask& task,
                                                                  const SurfacePlace& surface) {
  FourTexels texels{};
  for (unsigned left = surface.textured; left != 0;) {
    const IntLanes number = laneOf(baseOf(surface.kind), lowestBit(left));
    const IntLanes here = baseOf(surface.kind) == number;
    left &= ~signBits(here);
    const FourTexels read = masked(
        readTexels(texelBase(task, number[0]), masked(surface.place.at, here), surface.wraps),
        here);
    texels.upper_left |= read.upper_left;
    texels.upper_right |= read.upper_right;
    texels.lower_left |= read.lower_left;
    texels.lower_right |= read.lower_right;
  }
  return texels;
}

/// Texels, or the colors of flat surfaces.
[[gnu::always_inline]] GALACTIC_EVERYWHERE inline IntLanes sampleAt(const PaneTask& task,
                                                                    const SurfacePlace& surface) {
  if (surface.textured == 0) return surface.texels;
  const LevelPlace& place = surface.place;
  const FourTexels texels = surface.others == 0
                                ? readTexels(texelBase(task, surface.base), place.at, surface.wraps)
                                : readMixed(task, surface);
  const IntLanes flat = (surface.kind & 0xFF) == spread(static_cast<std::int32_t>(kFlatSurface));
  return pick(flat, surface.texels, bilinear(texels, place.share_right, place.share_down));
}

GALACTIC_EVERYWHERE inline IntLanes sampleTexels(const PaneTask& task,
                                                 const TexturePlaces& places) {
  SurfacePlace surface;
  placeSurface(
      places.texels, places.kind, [&] { return places; }, surface);
  return sampleAt(task, surface);
}

/// One record for all lanes.
struct OneRecord {
  const float* record;
  GALACTIC_EVERYWHERE Lanes field(std::uint32_t number) const { return spread(record[number]); }
  GALACTIC_EVERYWHERE IntLanes intField(std::uint32_t number) const {
    return as<IntLanes>(field(number));
  }
};

/// Some pixels: their places in the pane, from the center of its first pixel, and w.
struct PixelLanes {
  Lanes x, y, w;
};

template <class Records>
GALACTIC_EVERYWHERE inline TexturePlaces texturePlaces(const Records& records,
                                                       const PixelLanes& pixels) {
  const Lanes u_right = records.field(kURight);
  const Lanes u_down = records.field(kUDown);
  const Lanes v_right = records.field(kVRight);
  const Lanes v_down = records.field(kVDown);
  const Lanes w_right = records.field(kWRight);
  const Lanes w_down = records.field(kWDown);
  const Lanes u = (u_right * pixels.x + u_down * pixels.y + records.field(kUStart)) * pixels.w;
  const Lanes v = (v_right * pixels.x + v_down * pixels.y + records.field(kVStart)) * pixels.w;
  const Lanes u_x = (u_right - u * w_right) * pixels.w;
  const Lanes u_y = (u_down - u * w_down) * pixels.w;
  const Lanes v_x = (v_right - v * w_right) * pixels.w;
  const Lanes v_y = (v_down - v * w_down) * pixels.w;
  return {u, v, greater(u_x * u_x + v_x * v_x, u_y * u_y + v_y * v_y), records.intField(kTexels),
          records.intField(kKind)};
}

/// sampleTexels() where all lanes have one record.
GALACTIC_EVERYWHERE inline IntLanes sampleOne(const PaneTask& task, const OneRecord& record,
                                              const PixelLanes& pixels) {
  const auto kind = as<std::int32_t>(record.record[kKind]);
  const std::int32_t log_edge = kind & 0xFF;
  const IntLanes texels = record.intField(kTexels);
  if (log_edge == static_cast<std::int32_t>(kFlatSurface)) return texels;
  const TexturePlaces places = texturePlaces(record, pixels);
  const IntLanes size = spread(log_edge);
  IntLanes level = levelOf(places.squared_rate, size);
  // Mostly they need one level: numbers instead of vectors.
  const std::int32_t first = level[0];
  const bool alike = signBits(level == spread(first)) == kAllLanes;
  const Levels levels = alike ? oneLevel(first, log_edge, texels) : levelsAt(level, size, texels);
  const LevelPlace place = placeInLevel(places, levels);
  const FourTexels around =
      readTexels(texelBase(task, (kind >> 8) & 0x3FFFFF), place.at, signBits(place.wraps) != 0);
  return bilinear(around, place.share_right, place.share_down);
}

/// a * b / 255, rounded, for bytes.
GALACTIC_EVERYWHERE inline IntLanes byteProduct(IntLanes a, IntLanes b) {
  const IntLanes product = a * b + spread(128);
  return (product + (product >> 8)) >> 8;
}

/// Texels times the colors of the corners, interpolated by perspective.
template <class Records>
GALACTIC_EVERYWHERE inline IntLanes timesColors(IntLanes texels, const Records& colors,
                                                const PixelLanes& pixels) {
  IntLanes result = spread(0);
  for (std::uint32_t channel = 0; channel < 4; ++channel) {
    const Lanes value = (colors.field(3 * channel) * pixels.x +
                         colors.field(3 * channel + 1) * pixels.y + colors.field(3 * channel + 2)) *
                        pixels.w;
    const IntLanes factor = toInt(clampTo(value + spread(0.5F), 0, 255));
    const auto shift = static_cast<std::int32_t>(8 * channel);
    result |= byteProduct((texels >> shift) & 0xFF, factor) << shift;
  }
  return result;
}

/// Whether the surface of a triangle is there: all bits, or none.
GALACTIC_EVERYWHERE inline IntLanes alphaPasses(const PaneTask& task, const OneRecord& record,
                                                const OneRecord& colors, std::int32_t least_alpha,
                                                const PixelLanes& pixels) {
  IntLanes texels = sampleOne(task, record, pixels);
  if (as<std::int32_t>(record.record[kKind]) < 0) texels = timesColors(texels, colors, pixels);
  return ((texels >> 24) & 0xFF) >= spread(least_alpha);
}

/// What timesColors() multiplies by where red, green and blue are one. `light`: the record's fields
/// from kLightRight on.
GALACTIC_EVERYWHERE inline IntLanes lightAt(const Lanes* light, const PixelLanes& pixels) {
  const Lanes value = (light[0] * pixels.x + light[1] * pixels.y + light[2]) * pixels.w;
  return toInt(clampTo(value + spread(0.5F), 0, 255));
}

/// timesColors() where red, green and blue are one, and alpha is whole: the same bits.
GALACTIC_EVERYWHERE inline IntLanes timesLight(IntLanes texels, IntLanes light) {
  // Red and blue in one product.
  const WordLanes both = as<WordLanes>(texels & 0x00FF00FF) * as<WordLanes>(light) + 0x00800080U;
  const WordLanes red_blue = (both + ((both >> 8) & 0x00FF00FFU)) >> 8;
  const IntLanes green = byteProduct((texels >> 8) & 0xFF, light);
  return (as<IntLanes>(red_blue) & 0x00FF00FF) | green << 8 |
         (texels & static_cast<std::int32_t>(0xFF000000U));
}

}  // namespace
}  // namespace galactic::render
