// Computes the images from what is visible at each pixel, a vector of pixels at a time: one block
// if vectors have eight lanes, two blocks below each other if they have sixteen.
namespace galactic::render {
namespace {

/// The records of as many pixels as there are lanes, field by field.
struct EachRecord {
  Lanes fields[kRecordStride];
  Lanes field(std::uint32_t number) const { return fields[number]; }
  IntLanes intField(std::uint32_t number) const { return as<IntLanes>(fields[number]); }
};

/// A vector of pixels before its texels are read.
struct Shading {
  /// From the records; if no lane has a texture, only the last two members are set.
  TexturePlaces places;
  /// Not set if no lane has a texture.
  SurfacePlace surface;
  LaneSet flat;
  /// See lightAt(); not set if all pixels show the background.
  IntLanes light;

  bool isTextured() const { return (~bitsOf(flat) & kAllLanes) != 0; }
};

/// `ids`: of pixels that are not shaded yet.
[[gnu::always_inline]] inline void readRecords(const Pane& pane, const std::int32_t* ids,
                                               const PixelLanes& pixels, Shading& shading) {
  TexturePlaces& places = shading.places;
  if (signBits(-load<IntLanes>(ids)) == 0) {  // none above 0: background
    places.texels = spread(static_cast<std::int32_t>(pane.task->background));
    places.kind = spread(static_cast<std::int32_t>(kFlatSurface));
    shading.flat = setOf(kAllLanes);
    return;
  }
  EachRecord each;
  const float* records = pane.scratch->records;
  gatherRows(records + kTexels, ids, each.fields + kTexels);
  shading.light = lightAt(each.fields + kLightRight, pixels);
  shading.flat = flatLanes(each.intField(kKind));
  if (!shading.isTextured()) {
    places.texels = each.intField(kTexels);
    places.kind = each.intField(kKind);
    return;
  }
  gatherRows(records, ids, each.fields);
  places = texturePlaces(each, pixels);
}

inline void placeTexels(Shading& shading) {
  if (shading.isTextured()) placeSurface(shading.places, shading.flat, shading.surface);
}

/// `pixels`: a function that returns the pixels, called only if colors have to be interpolated.
template <class Pixels>
[[gnu::always_inline]] inline IntLanes finishShading(const Pane& pane, const std::int32_t* ids,
                                                     const Pixels& pixels, const Shading& shading) {
  const IntLanes kind = shading.places.kind;
  IntLanes colors = shading.places.texels;
  if (shading.isTextured()) colors = sampleAt(*pane.task, shading.places, shading.surface);
  if (signBits(kind) != 0) {
    // Lanes without colors read record 0.
    alignas(kVectorBytes) std::int32_t colored[kLanes];
    store(colored, load<IntLanes>(ids) & (kind >> 31));
    EachRecord planes;
    gatherRows(pane.scratch->colors, colored, planes.fields);
    gatherRows(pane.scratch->colors + 8, colored, planes.fields + 8);
    colors = pickFrom(bySign(kind), timesColors(colors, planes, pixels()), colors);
  }
  const LaneSet lit = bySign(kind << 1);
  if (bitsOf(lit) != 0) colors = pickFrom(lit, timesLight(colors, shading.light), colors);
  // Whatever is drawn is opaque: its alpha is 255.
  return pickFrom(whereEqual(load<IntLanes>(ids), spread(0)), colors,
                  colors | static_cast<std::int32_t>(0xFF000000U));
}

/// `ids`: of pixels that are not shaded yet.
inline IntLanes semanticsOf(const Pane& pane, const std::int32_t* ids) {
  return gather(reinterpret_cast<const std::int32_t*>(pane.scratch->records) + kSemantic,
                load<IntLanes>(ids));
}

/// Where the pixels of a vector lie in the whole image, and how many columns and rows of them are
/// inside the pane.
struct BlockTarget {
  std::size_t pixel;
  std::uint32_t width, height;
};

inline BlockTarget blockTarget(const PaneTask& task, std::uint32_t column, std::uint32_t row) {
  const std::uint32_t x = column * kBlockWidth;
  const std::uint32_t y = row * kBlockHeight;
  const std::uint32_t wide = task.width - x < kBlockWidth ? task.width - x : kBlockWidth;
  const std::uint32_t high = task.height - y < kHigh ? task.height - y : kHigh;
  return {static_cast<std::size_t>(task.top + y) * task.image_width + task.left + x, wide, high};
}

/// Writes elements of four bytes to an image.
inline void writeWords(const PaneTask& task, const BlockTarget& target, void* image,
                       IntLanes words) {
  auto* to = static_cast<std::uint8_t*>(image) + 4 * target.pixel;
  if (target.width == kBlockWidth && target.height == kHigh) {
    return storeBlocks(to, std::size_t{4} * task.image_width, words);
  }
  alignas(kVectorBytes) std::uint8_t bytes[4 * kLanes];
  store(bytes, words);
  constexpr std::size_t kRowBytes = std::size_t{4} * kBlockWidth;
  for (std::uint32_t y = 0; y < target.height; ++y, to += std::size_t{4} * task.image_width) {
    __builtin_memcpy(to, bytes + kRowBytes * y, std::size_t{4} * target.width);
  }
}

/// Column and row of a lane's pixel within its vector.
constexpr std::uint32_t laneX(std::uint32_t lane) { return lane % kBlockWidth; }
constexpr std::uint32_t laneY(std::uint32_t lane) { return lane / kBlockWidth; }

/// Writes colors without their alpha.
inline void writeTriples(const PaneTask& task, const BlockTarget& target, IntLanes words) {
  alignas(kVectorBytes) std::uint8_t bytes[4 * kLanes];
  store(bytes, words);
  for (std::uint32_t n = 0; n < kLanes; ++n) {
    const std::uint32_t x = laneX(n);
    const std::uint32_t y = laneY(n);
    if (x >= target.width || y >= target.height) continue;
    std::uint8_t* to = task.color + 3 * (target.pixel + y * std::size_t{task.image_width} + x);
    for (std::uint32_t c = 0; c < 3; ++c) to[c] = bytes[4 * n + c];
  }
}

/// Replaces pixels that have already been shaded by what the image has there.
inline IntLanes keepShaded(const PaneTask& task, const BlockTarget& target, IntLanes ids,
                           IntLanes words, const std::uint8_t* image, std::uint32_t bytes_each) {
  for (std::uint32_t n = 0; n < kLanes; ++n) {
    const std::uint32_t x = laneX(n);
    const std::uint32_t y = laneY(n);
    if (ids[n] != kShaded || x >= target.width || y >= target.height) continue;
    std::uint32_t word = 0;
    const std::size_t pixel = target.pixel + y * std::size_t{task.image_width} + x;
    __builtin_memcpy(&word, image + pixel * bytes_each, bytes_each);
    words[n] = static_cast<std::int32_t>(word);
  }
  return words;
}

/// A vector of pixels while it is resolved: what is visible at each, and where it goes.
struct Resolving {
  BlockTarget target;
  PixelLanes pixels;
  /// `ids`: as in the pane; `shown`: the same with 0 in place of kShaded.
  const std::int32_t* ids;
  alignas(kVectorBytes) std::int32_t shown[kLanes];
  Shading shading;
};

[[gnu::noinline]] void beginColors(const Pane& pane, std::uint32_t column, std::uint32_t row,
                                   Lanes w, Resolving& pixels) {
  pixels.ids = placeOf(pane, column, row).ids;
  pixels.pixels = pixelsOf(column, row, w);
  const auto id = load<IntLanes>(pixels.ids);
  store(pixels.shown, id & ~(id >> 31));
  if (pane.task->color == nullptr) return;
  readRecords(pane, pixels.shown, pixels.pixels, pixels.shading);
  placeTexels(pixels.shading);
}

[[gnu::noinline]] void endColors(const Pane& pane, const Resolving& pixels) {
  const PaneTask& task = *pane.task;
  const BlockTarget& target = pixels.target;
  const auto id = load<IntLanes>(pixels.ids);
  const bool any_shaded = signBits(id) != 0;
  if (task.color != nullptr) {
    IntLanes colors = finishShading(
        pane, pixels.shown, [&] { return pixels.pixels; }, pixels.shading);
    if (any_shaded) colors = keepShaded(task, target, id, colors, task.color, task.channels);
    if (task.channels == 4) {
      writeWords(task, target, task.color, colors);
    } else {
      writeTriples(task, target, colors);
    }
  }
  if (task.semantics == nullptr) return;
  IntLanes semantics = semanticsOf(pane, pixels.shown);
  if (any_shaded) {
    semantics = keepShaded(task, target, id, semantics,
                           reinterpret_cast<const std::uint8_t*>(task.semantics), 4);
  }
  writeWords(task, target, task.semantics, semantics);
}

/// Writes a vector of pixels, some of which may lie outside the image or have already been shaded.
inline void resolveVector(const Pane& pane, std::uint32_t column, std::uint32_t row) {
  const PaneTask& task = *pane.task;
  Resolving pixels;
  pixels.target = blockTarget(task, column, row);
  const Lanes z = load<Lanes>(placeOf(pane, column, row).depth);
  const Lanes w = spread(1.0F) / z;
  if (task.depth != nullptr) {
    writeWords(task, pixels.target, task.depth, as<IntLanes>(w) & (z > spread(0.0F)));
  }
  if (!pane.shades) return;
  beginColors(pane, column, row, w, pixels);
  endColors(pane, pixels);
}

/// This many vectors take each step together. None of them waits for the one before, so the
/// processor works on several at a time, and there is time to load the texels.
constexpr std::uint32_t kTogether = 16;

/// `count` vectors of pixels, at most kTogether, that lie beside each other and entirely inside the
/// image and have not been shaded yet.
struct WholeVectors {
  const Pane& pane;
  std::uint32_t column, row, count;
  /// How many rows of pixels further down the next row of vectors lies; 0 if there is none.
  std::uint32_t below;
  BlockPlace place = placeOf(pane, column, row);
  BlockTarget target = blockTarget(*pane.task, column, row);

  const std::int32_t* ids(std::uint32_t n) const { return place.ids + std::size_t{n} * kLanes; }
  Lanes depth(std::uint32_t n) const { return load<Lanes>(place.depth + std::size_t{n} * kLanes); }
  PixelLanes pixels(std::uint32_t n) const {
    return pixelsOf(column + n, row, spread(1.0F) / depth(n));
  }
  /// Writes elements of four bytes.
  void write(void* image, std::uint32_t n, IntLanes words) const {
    auto* to =
        static_cast<std::uint8_t*>(image) + 4 * (target.pixel + std::size_t{n} * kBlockWidth);
    storeBlocks(to, std::size_t{4} * pane.task->image_width, words);
  }
  void writeColors(std::uint32_t n, IntLanes colors) const {
    const PaneTask& task = *pane.task;
    if (task.channels == 4) return write(task.color, n, colors);
    writeTriples(task, blockTarget(task, column + n, row), colors);
  }
};

/// Prefetches a part of an image with `bytes_each` bytes per pixel that will be written soon: the
/// rows of pixels below these vectors. After each vector has done so, all of it is prefetched.
/// Always inline, because the compiler drops calls of functions that do nothing else.
[[gnu::always_inline]] inline void fetchBelow(const WholeVectors& vectors, std::uint32_t n,
                                              const void* image, std::size_t bytes_each) {
  const std::uint32_t row = n % kHigh;
  const std::size_t pixel = vectors.target.pixel + std::size_t{n - row} * kBlockWidth +
                            std::size_t{vectors.below + row} * vectors.pane.task->image_width;
  __builtin_prefetch(static_cast<const std::uint8_t*>(image) + bytes_each * pixel, 1);
}

/// Not inline, because GCC 12 fails if it sees this as part of a loop.
[[gnu::noinline]] void writeSemantics(const WholeVectors& vectors, std::uint32_t n) {
  vectors.write(vectors.pane.task->semantics, n, semanticsOf(vectors.pane, vectors.ids(n)));
}

inline void resolveVectors(const WholeVectors& vectors) {
  const Pane& pane = vectors.pane;
  const PaneTask& task = *pane.task;
  Shading shadings[kTogether];
  PixelLanes pixels = vectors.pixels(0);
  for (std::uint32_t n = 0; n < vectors.count; ++n) {
    pixels.w = spread(1.0F) / vectors.depth(n);
    const IntLanes seen = vectors.depth(n) > spread(0.0F);
    if (task.depth != nullptr) {
      fetchBelow(vectors, n, task.depth, sizeof(float));
      vectors.write(task.depth, n, as<IntLanes>(pixels.w) & seen);
    }
    if (task.color != nullptr) {
      fetchBelow(vectors, n, task.color, task.channels);
      readRecords(pane, vectors.ids(n), pixels, shadings[n]);
    }
    pixels.x = pixels.x + spread(static_cast<float>(kBlockWidth));
  }
  if (task.color != nullptr) {
    for (std::uint32_t n = 0; n < vectors.count; ++n) placeTexels(shadings[n]);
    for (std::uint32_t n = 0; n < vectors.count; ++n) {
      const auto again = [&] { return vectors.pixels(n); };
      vectors.writeColors(n, finishShading(pane, vectors.ids(n), again, shadings[n]));
    }
  }
  if (task.semantics == nullptr) return;
  for (std::uint32_t n = 0; n < vectors.count; ++n) writeSemantics(vectors, n);
}

/// Writes the images.
inline void resolve(const Pane& pane) {
  const PaneTask& task = *pane.task;
  const std::uint32_t shown_columns = (task.width + kBlockWidth - 1) / kBlockWidth;
  const std::uint32_t shown_rows = (task.height + kBlockHeight - 1) / kBlockHeight;
  const std::uint32_t whole_columns = task.width / kBlockWidth;
  const std::uint32_t whole_rows = pane.has_shaded ? 0 : task.height / kHigh * kBlocks;
  for (std::uint32_t row = 0; row < shown_rows; row += kBlocks) {
    std::uint32_t column = 0;
    while (row < whole_rows && column < whole_columns) {
      const std::uint32_t left = whole_columns - column;
      const std::uint32_t count = left < kTogether ? left : kTogether;
      const std::uint32_t below = row + kBlocks < whole_rows ? kHigh : 0;
      resolveVectors({pane, column, row, count, below});
      column += count;
    }
    for (; column < shown_columns; ++column) resolveVector(pane, column, row);
  }
}

/// Shades what is visible so far, so that the records can be used again.
inline void makeRoom(Pane& pane) {
  const PaneTask& task = *pane.task;
  for (std::uint32_t row = 0; row < pane.rows; row += kBlocks) {
    for (std::uint32_t column = 0; column < pane.columns; ++column) {
      const BlockPlace place = placeOf(pane, column, row);
      const auto ids = load<IntLanes>(place.ids);
      if (signBits(spread(0) - ids) == 0) continue;  // none above 0
      Resolving pixels;
      pixels.target = blockTarget(task, column, row);
      beginColors(pane, column, row, spread(1.0F) / load<Lanes>(place.depth), pixels);
      endColors(pane, pixels);
      store(place.ids, pick(ids > spread(0), spread(kShaded), ids));
    }
  }
  pane.records = 1;
  pane.has_shaded = true;
}

}  // namespace
}  // namespace galactic::render
