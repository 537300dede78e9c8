// Colors of a vector of pixels from the records of their triangles: perspective-correct texture
// coordinates, the mip level that comes closest to one texel per pixel, and bilinear filtering
// between four of its texels, as with GL_LINEAR_MIPMAP_NEAREST. Colors are weighted as they are
// stored (sRGB), with weights of 8 bits.
namespace galactic::render {
namespace {

/// Where some pixels lie on their textures.
struct TexturePlaces {
  /// In texels of the largest level.
  Lanes u, v;
  /// Square of the texels per pixel, in the direction where there are more.
  Lanes squared_rate;
  IntLanes texels, kind;
};

struct FourTexels {
  IntLanes upper_left, upper_right, lower_left, lower_right;
};

GALACTIC_EVERYWHERE inline IntLanes bilinear(const FourTexels& t, Lanes share_right,
                                             Lanes share_down) {
  const ShortLanes right = blendWeight(share_right);
  const ShortLanes down = blendWeight(share_down);
  const auto even = [](IntLanes v) { return as<ShortLanes>(v & 0x00FF00FF); };
  const auto odd = [](IntLanes v) { return as<ShortLanes>(v) >> 8; };
  const ShortLanes low = blend(blend(even(t.upper_left), even(t.upper_right), right),
                               blend(even(t.lower_left), even(t.lower_right), right), down);
  const ShortLanes high = blend(blend(odd(t.upper_left), odd(t.upper_right), right),
                                blend(odd(t.lower_left), odd(t.lower_right), right), down);
  return as<IntLanes>(low | high << 8);
}

/// Levels of textures.
struct Levels {
  /// Factor from texels of the largest level to texels of this one.
  Lanes scale;
  /// The number of the first texel, log2 of the edge, and the edge minus 1.
  IntLanes first, log_edge, wrap;
};

/// The level with about one texel per pixel, for textures whose edges are 2^size.
GALACTIC_EVERYWHERE inline IntLanes levelOf(Lanes squared_rate, IntLanes size) {
  // log4 of twice the square, rounded down, which changes half-way between two levels. The bits of
  // a float from bit 23 on are its log2 plus 127.
  const IntLanes level = (as<IntLanes>(squared_rate) - spread(126 << 23)) >> 24;
  return lesser(greater(level, spread(0)), size);
}

/// The same level for all lanes.
GALACTIC_EVERYWHERE inline Levels oneLevel(std::int32_t level, std::int32_t size, IntLanes texels) {
  const std::int32_t log_edge = size - level;
  const std::uint32_t before = 0x55555555U & ((4U << (2 * size)) - (4U << (2 * log_edge)));
  return {spread(as<float>((127 - level) << 23)),
          texels + spread(static_cast<std::int32_t>(before)), spread(log_edge),
          spread((1 << log_edge) - 1)};
}

GALACTIC_EVERYWHERE inline Levels levelsAt(IntLanes level, IntLanes size, IntLanes texels) {
  const IntLanes log_edge = size - level;
  // The texels of all larger levels: a sum of powers of 4.
  const IntLanes before =
      spread(0x55555555) & ((spread(4) << (size + size)) - (spread(4) << (log_edge + log_edge)));
  return {as<Lanes>((spread(127) - level) << 23), texels + before, log_edge,
          (spread(1) << log_edge) - spread(1)};
}

/// A place in one level of a texture: the two left ones of the four texels around it, and the
/// weights of the right and the lower texels.
struct LevelPlace {
  IntLanes upper_left, lower_left;
  /// From the left texels to the right ones: 1, except where the texture repeats.
  IntLanes to_right;
  Lanes share_right, share_down;
  LaneSet begins_again;
};

GALACTIC_EVERYWHERE inline LevelPlace placeInLevel(const TexturePlaces& places,
                                                   const Levels& level) {
  constexpr float kFarthest = 1 << 22;
  const Lanes u = clampTo(places.u * level.scale - spread(0.5F), -kFarthest, kFarthest);
  const Lanes v = clampTo(places.v * level.scale - spread(0.5F), -kFarthest, kFarthest);
  const auto left = roundedDown(u);
  const auto upper = roundedDown(v);
  const IntLanes row0 = (upper.whole & level.wrap) << level.log_edge;
  const IntLanes row1 = ((upper.whole + spread(1)) & level.wrap) << level.log_edge;
  const IntLanes column = left.whole & level.wrap;
  const IntLanes first = level.first + column;
  const LaneSet last = whereEqual(column, level.wrap);
  return {first + row0,   first + row1,    pickFrom(last, -level.wrap, spread(1)),
          u - left.value, v - upper.value, last};
}

GALACTIC_EVERYWHERE inline const std::int32_t* texelBase(const PaneTask& task,
                                                         std::int32_t number) {
  return reinterpret_cast<const std::int32_t*>(task.texel_bases[number]);
}

/// Reads texels of one base. If the right texels follow the left ones in memory, both are read at
/// once, which halves the work of vectors. `wraps`: in at least one lane they do not.
[[gnu::always_inline]] GALACTIC_EVERYWHERE inline FourTexels readTexels(const std::int32_t* from,
                                                                        const LevelPlace& place,
                                                                        bool wraps) {
  if (kLanes > 1 && !wraps) {
    const Pair<IntLanes> upper = gatherNeighbors(from, place.upper_left);
    const Pair<IntLanes> lower = gatherNeighbors(from, place.lower_left);
    return {upper.first, upper.second, lower.first, lower.second};
  }
  return {gather(from, place.upper_left), gather(from, place.upper_left + place.to_right),
          gather(from, place.lower_left), gather(from, place.lower_left + place.to_right)};
}

/// Makes lanes outside the set read texel 0 of the base.
GALACTIC_EVERYWHERE inline void keepOnly(LaneSet set, LevelPlace& place) {
  place.upper_left = pickFrom(set, place.upper_left, spread(0));
  place.lower_left = pickFrom(set, place.lower_left, spread(0));
  place.to_right = pickFrom(set, place.to_right, spread(0));
}

/// Where the texels of some pixels lie, and how they have to be read. It is computed in advance, so
/// that reading need not wait for these numbers.
struct SurfacePlace {
  LevelPlace place;
  /// Bit n of `textured`: lane n has a texture. Bit n of `others`: its texture has another base
  /// than that of the first textured lane.
  unsigned textured, others;
  /// The base of the first textured lane.
  std::int32_t base;
  bool wraps;
};

GALACTIC_EVERYWHERE inline IntLanes baseOf(IntLanes kind) { return (kind >> 8) & 0x3FFFFF; }

/// Lanes whose surface has a single color, including those without a triangle.
GALACTIC_EVERYWHERE inline LaneSet flatLanes(IntLanes kind) {
  return whereEqual(kind & 0xFF, spread(static_cast<std::int32_t>(kFlatSurface)));
}

/// At least one lane must have a texture. `flat`: see flatLanes().
GALACTIC_EVERYWHERE inline void placeSurface(const TexturePlaces& places, LaneSet flat,
                                             SurfacePlace& surface) {
  const IntLanes kind = places.kind;
  const IntLanes size = pickFrom(flat, spread(0), kind & 0xFF);
  LevelPlace& place = surface.place;
  place = placeInLevel(places, levelsAt(levelOf(places.squared_rate, size), size, places.texels));
  surface.textured = ~bitsOf(flat) & kAllLanes;
  keepOnly(setOf(surface.textured), place);
  surface.wraps = (bitsOf(place.begins_again) & surface.textured) != 0;
  const IntLanes first = laneOf(baseOf(kind), lowestBit(surface.textured));
  surface.base = first[0];
  surface.others = ~bitsOf(whereEqual(baseOf(kind), first)) & surface.textured;
}

/// Reads texels of several bases.
[[gnu::noinline]] GALACTIC_EVERYWHERE inline FourTexels readMixed(const PaneTask& task,
                                                                  const SurfacePlace& surface,
                                                                  IntLanes kind) {
  FourTexels texels{};
  for (unsigned left = surface.textured; left != 0;) {
    const IntLanes number = laneOf(baseOf(kind), lowestBit(left));
    const LaneSet here = whereEqual(baseOf(kind), number);
    left &= ~bitsOf(here);
    LevelPlace place = surface.place;
    keepOnly(here, place);
    const FourTexels read = readTexels(texelBase(task, number[0]), place, surface.wraps);
    texels.upper_left = pickFrom(here, read.upper_left, texels.upper_left);
    texels.upper_right = pickFrom(here, read.upper_right, texels.upper_right);
    texels.lower_left = pickFrom(here, read.lower_left, texels.lower_left);
    texels.lower_right = pickFrom(here, read.lower_right, texels.lower_right);
  }
  return texels;
}

/// Texels, or the colors of flat surfaces. At least one lane must have a texture.
[[gnu::always_inline]] GALACTIC_EVERYWHERE inline IntLanes sampleAt(const PaneTask& task,
                                                                    const TexturePlaces& places,
                                                                    const SurfacePlace& surface) {
  const LevelPlace& place = surface.place;
  const FourTexels texels = surface.others == 0
                                ? readTexels(texelBase(task, surface.base), place, surface.wraps)
                                : readMixed(task, surface, places.kind);
  return pickFrom(setOf(surface.textured), bilinear(texels, place.share_right, place.share_down),
                  places.texels);
}

GALACTIC_EVERYWHERE inline IntLanes sampleTexels(const PaneTask& task,
                                                 const TexturePlaces& places) {
  const LaneSet flat = flatLanes(places.kind);
  if ((bitsOf(flat) & kAllLanes) == kAllLanes) return places.texels;
  SurfacePlace surface;
  placeSurface(places, flat, surface);
  return sampleAt(task, places, surface);
}

/// One record for all lanes.
struct OneRecord {
  const float* record;
  GALACTIC_EVERYWHERE Lanes field(std::uint32_t number) const { return spread(record[number]); }
  GALACTIC_EVERYWHERE IntLanes intField(std::uint32_t number) const {
    return as<IntLanes>(field(number));
  }
};

/// Some pixels: their places in the pane, counted from the center of its first pixel, and their w.
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

/// Like sampleTexels(), if all lanes have the same record.
GALACTIC_EVERYWHERE inline IntLanes sampleOne(const PaneTask& task, const OneRecord& record,
                                              const PixelLanes& pixels) {
  const auto kind = as<std::int32_t>(record.record[kKind]);
  const std::int32_t log_edge = kind & 0xFF;
  const IntLanes texels = record.intField(kTexels);
  if (log_edge == static_cast<std::int32_t>(kFlatSurface)) return texels;
  const TexturePlaces places = texturePlaces(record, pixels);
  const IntLanes size = spread(log_edge);
  IntLanes level = levelOf(places.squared_rate, size);
  // Most often all lanes need the same level, which can be computed with numbers instead of
  // vectors.
  const std::int32_t first = level[0];
  const bool alike = signBits(level == spread(first)) == kAllLanes;
  const Levels levels = alike ? oneLevel(first, log_edge, texels) : levelsAt(level, size, texels);
  const LevelPlace place = placeInLevel(places, levels);
  const FourTexels around =
      readTexels(texelBase(task, (kind >> 8) & 0x3FFFFF), place, bitsOf(place.begins_again) != 0);
  return bilinear(around, place.share_right, place.share_down);
}

/// a * b / 255, rounded, for bytes.
GALACTIC_EVERYWHERE inline IntLanes byteProduct(IntLanes a, IntLanes b) {
  const IntLanes product = a * b + spread(128);
  return (product + (product >> 8)) >> 8;
}

/// Texels times the colors of the corners, interpolated with perspective.
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

/// Whether the surface of a triangle has no hole at these pixels: all bits, or none.
GALACTIC_EVERYWHERE inline IntLanes alphaPasses(const PaneTask& task, const OneRecord& record,
                                                const OneRecord& colors, std::int32_t least_alpha,
                                                const PixelLanes& pixels) {
  IntLanes texels = sampleOne(task, record, pixels);
  if (as<std::int32_t>(record.record[kKind]) < 0) texels = timesColors(texels, colors, pixels);
  return ((texels >> 24) & 0xFF) >= spread(least_alpha);
}

/// The factor of timesColors() if red, green and blue are equal. `light`: the record's fields from
/// kLightRight on.
GALACTIC_EVERYWHERE inline IntLanes lightAt(const Lanes* light, const PixelLanes& pixels) {
  const Lanes value = (light[0] * pixels.x + light[1] * pixels.y + light[2]) * pixels.w;
  return toInt(clampTo(value + spread(0.5F), 0, 255));
}

/// Returns the same bits as timesColors() if red, green and blue are equal and alpha is 255.
GALACTIC_EVERYWHERE inline IntLanes timesLight(IntLanes texels, IntLanes light) {
  const auto both = as<ShortLanes>(light | light << 16);
  const ShortLanes low = byteProducts(as<ShortLanes>(texels & 0x00FF00FF), both);
  const ShortLanes high = byteProducts(as<ShortLanes>(texels) >> 8, both);
  return (as<IntLanes>(low | high << 8) & 0x00FFFFFF) |
         (texels & static_cast<std::int32_t>(0xFF000000U));
}

}  // namespace
}  // namespace galactic::render
