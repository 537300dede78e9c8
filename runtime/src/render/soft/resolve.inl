// From what is seen at each pixel to the images.
namespace galactic::render {
namespace {

using Quad = float __attribute__((vector_size(16)));

/// Four numbers of eight records become a vector each.
inline void loadFour(const float* records, const std::int32_t* ids, Lanes* fields) {
  Lanes pairs[4];
  for (int n = 0; n < 4; ++n) {
    const auto near =
        load<Quad>(records + std::size_t{kRecordStride} * static_cast<std::uint32_t>(ids[n]));
    const auto far =
        load<Quad>(records + std::size_t{kRecordStride} * static_cast<std::uint32_t>(ids[n + 4]));
    pairs[n] = __builtin_shufflevector(near, far, 0, 1, 2, 3, 4, 5, 6, 7);
  }
  const Lanes a = __builtin_shufflevector(pairs[0], pairs[1], 0, 8, 1, 9, 4, 12, 5, 13);
  const Lanes b = __builtin_shufflevector(pairs[0], pairs[1], 2, 10, 3, 11, 6, 14, 7, 15);
  const Lanes c = __builtin_shufflevector(pairs[2], pairs[3], 0, 8, 1, 9, 4, 12, 5, 13);
  const Lanes d = __builtin_shufflevector(pairs[2], pairs[3], 2, 10, 3, 11, 6, 14, 7, 15);
  fields[0] = __builtin_shufflevector(a, c, 0, 1, 8, 9, 4, 5, 12, 13);
  fields[1] = __builtin_shufflevector(a, c, 2, 3, 10, 11, 6, 7, 14, 15);
  fields[2] = __builtin_shufflevector(b, d, 0, 1, 8, 9, 4, 5, 12, 13);
  fields[3] = __builtin_shufflevector(b, d, 2, 3, 10, 11, 6, 7, 14, 15);
}

/// The records of eight pixels, field by field.
struct EachRecord {
  Lanes fields[kRecordFields];
  Lanes field(std::uint32_t number) const { return fields[number]; }
  IntLanes intField(std::uint32_t number) const { return as<IntLanes>(fields[number]); }
};

inline EachRecord loadRecords(const float* records, const std::int32_t* ids) {
  static_assert(kRecordFields == kColorFields);
  EachRecord each;
  for (std::uint32_t n = 0; n < kRecordFields; n += 4) loadFour(records + n, ids, each.fields + n);
  return each;
}

/// Eight pixels of one triangle.
inline IntLanes shadeAlike(const Pane& pane, std::uint32_t id, const PixelLanes& pixels) {
  const OneRecord record{recordAt(pane, id)};
  IntLanes colors = sampleOne(*pane.task, record, pixels);
  const auto bits = as<std::uint32_t>(record.record[kKind]);
  if ((bits & kHasColors) != 0) {
    colors = timesColors(colors, OneRecord{colorsAt(pane, id)}, pixels);
  }
  if ((bits & kHasLight) != 0) {
    const Lanes light[3] = {record.field(kLightRight), record.field(kLightDown),
                            record.field(kLightStart)};
    colors = timesLight(colors, light, pixels);
  }
  return colors | static_cast<std::int32_t>(0xFF000000U);
}

/// Eight pixels of several triangles.
inline IntLanes shadeMixed(const Pane& pane, const std::int32_t* ids, const PixelLanes& pixels) {
  const auto id = load<IntLanes>(ids);
  const TexturePlaces places = texturePlaces(loadRecords(pane.scratch->records, ids), pixels);
  IntLanes colors = sampleTexels(*pane.task, places);
  const IntLanes kind = places.kind;
  if (signBits(kind) != 0) {
    // Lanes without colors look at record 0.
    alignas(32) std::int32_t colored[kWidth];
    store(colored, id & (kind >> 31));
    const EachRecord planes = loadRecords(pane.scratch->colors, colored);
    colors = pick(kind >> 31, timesColors(colors, planes, pixels), colors);
  }
  const IntLanes lit = kind << 1;
  if (signBits(lit) != 0) {
    Lanes light[4];
    loadFour(pane.scratch->records + kLightRight, ids, light);
    colors = pick(lit >> 31, timesLight(colors, light, pixels), colors);
  }
  // What is drawn hides all behind it.
  return pick(id == spread(0), colors, colors | static_cast<std::int32_t>(0xFF000000U));
}

/// `ids`: 0 or more, not all of them 0.
inline IntLanes shade(const Pane& pane, const std::int32_t* ids, const PixelLanes& pixels) {
  const bool alike = signBits(load<IntLanes>(ids) == spread(ids[0])) == kAllLanes;
  return alike ? shadeAlike(pane, static_cast<std::uint32_t>(ids[0]), pixels)
               : shadeMixed(pane, ids, pixels);
}

/// Where a block of pixels lies in the whole image, and how much of it is within.
struct BlockTarget {
  std::size_t pixel;
  std::uint32_t width, height;
};

inline BlockTarget blockTarget(const PaneTask& task, std::uint32_t column, std::uint32_t row) {
  const std::uint32_t x = column * kBlockWidth;
  const std::uint32_t y = row * kBlockHeight;
  const std::uint32_t wide = task.width - x < kBlockWidth ? task.width - x : kBlockWidth;
  const std::uint32_t high = task.height - y < kBlockHeight ? task.height - y : kBlockHeight;
  return {static_cast<std::size_t>(task.top + y) * task.image_width + task.left + x, wide, high};
}

/// Writes eight elements of four bytes to a block of an image.
inline void writeWords(const PaneTask& task, const BlockTarget& target, void* image,
                       IntLanes words) {
  auto* to = static_cast<std::uint8_t*>(image) + 4 * target.pixel;
  alignas(32) std::uint8_t bytes[4 * kWidth];
  store(bytes, words);
  if (target.width == kBlockWidth) {
    __builtin_memcpy(to, bytes, 4 * kBlockWidth);
  } else {
    __builtin_memcpy(to, bytes, std::size_t{4} * target.width);
  }
  if (target.height < kBlockHeight) return;
  to += std::size_t{4} * task.image_width;
  if (target.width == kBlockWidth) {
    __builtin_memcpy(to, bytes + 4 * kBlockWidth, 4 * kBlockWidth);
  } else {
    __builtin_memcpy(to, bytes + 4 * kBlockWidth, std::size_t{4} * target.width);
  }
}

/// Writes eight colors without their alpha.
inline void writeTriples(const PaneTask& task, const BlockTarget& target, IntLanes words) {
  alignas(32) std::uint8_t bytes[4 * kWidth];
  store(bytes, words);
  for (std::uint32_t y = 0; y < target.height; ++y) {
    std::uint8_t* to = task.color + 3 * (target.pixel + y * std::size_t{task.image_width});
    const std::uint8_t* from = bytes + std::size_t{y} * 4 * kBlockWidth;
    for (std::uint32_t x = 0; x < target.width; ++x, to += 3, from += 4) {
      to[0] = from[0];
      to[1] = from[1];
      to[2] = from[2];
    }
  }
}

/// Puts what the image has already in the place of pixels that are shaded.
inline IntLanes keepShaded(const PaneTask& task, const BlockTarget& target, IntLanes ids,
                           IntLanes words, const std::uint8_t* image, std::uint32_t bytes_each) {
  for (std::uint32_t n = 0; n < kWidth; ++n) {
    const std::uint32_t x = n % kBlockWidth;
    const std::uint32_t y = n / kBlockWidth;
    if (ids[n] != kShaded || x >= target.width || y >= target.height) continue;
    std::uint32_t word = 0;
    const std::size_t pixel = target.pixel + y * std::size_t{task.image_width} + x;
    __builtin_memcpy(&word, image + pixel * bytes_each, bytes_each);
    words[n] = static_cast<std::int32_t>(word);
  }
  return words;
}

inline void resolveColors(const Pane& pane, const BlockTarget& target, const std::int32_t* ids,
                          const PixelLanes& pixels) {
  const PaneTask& task = *pane.task;
  const auto id = load<IntLanes>(ids);
  const bool any_shaded = signBits(id) != 0;
  alignas(32) std::int32_t valid[kWidth];
  if (any_shaded) store(valid, id & ~(id >> 31));
  const std::int32_t* shown = any_shaded ? valid : ids;
  if (task.color != nullptr) {
    IntLanes colors = spread(static_cast<std::int32_t>(task.background));
    if (signBits(load<IntLanes>(shown) == spread(0)) != kAllLanes) {
      colors = shade(pane, shown, pixels);
    }
    if (any_shaded) colors = keepShaded(task, target, id, colors, task.color, task.channels);
    if (task.channels == 4) {
      writeWords(task, target, task.color, colors);
    } else {
      writeTriples(task, target, colors);
    }
  }
  if (task.semantics == nullptr) return;
  IntLanes semantics =
      gather(reinterpret_cast<const std::int32_t*>(pane.scratch->records) + kSemantic,
             load<IntLanes>(shown) * static_cast<std::int32_t>(kRecordStride));
  if (any_shaded) {
    semantics = keepShaded(task, target, id, semantics,
                           reinterpret_cast<const std::uint8_t*>(task.semantics), 4);
  }
  writeWords(task, target, task.semantics, semantics);
}

/// Writes the images.
void resolve(const Pane& pane) {
  const PaneTask& task = *pane.task;
  const float* depth = pane.scratch->depth;
  const std::int32_t* ids = pane.scratch->ids;
  const std::uint32_t shown_columns = (task.width + kBlockWidth - 1) / kBlockWidth;
  const std::uint32_t shown_rows = (task.height + kBlockHeight - 1) / kBlockHeight;
  for (std::uint32_t row = 0; row < shown_rows; ++row) {
    for (std::uint32_t column = 0; column < shown_columns; ++column) {
      const std::size_t at = (std::size_t{row} * pane.columns + column) * kWidth;
      const Lanes z = load<Lanes>(depth + at);
      const BlockTarget target = blockTarget(task, column, row);
      const Lanes w = spread(1.0F) / z;
      if (task.depth != nullptr) {
        writeWords(task, target, task.depth, as<IntLanes>(w) & (z > spread(0.0F)));
      }
      if (pane.shades) {
        resolveColors(pane, target, ids + at, pixelsOf(column, row, w));
      }
    }
  }
}

/// Shades what is seen so far, so that the records can be used again.
void makeRoom(Pane& pane) {
  const PaneTask& task = *pane.task;
  for (std::uint32_t row = 0; row < pane.rows; ++row) {
    for (std::uint32_t column = 0; column < pane.columns; ++column) {
      const std::size_t at = (std::size_t{row} * pane.columns + column) * kWidth;
      const IntLanes ids = load<IntLanes>(pane.scratch->ids + at);
      if (signBits(spread(0) - ids) == 0) continue;  // none above 0
      const Lanes z = load<Lanes>(pane.scratch->depth + at);
      resolveColors(pane, blockTarget(task, column, row), pane.scratch->ids + at,
                    pixelsOf(column, row, spread(1.0F) / z));
      store(pane.scratch->ids + at, pick(ids > spread(0), spread(kShaded), ids));
    }
  }
  pane.records = 1;
}

}  // namespace
}  // namespace galactic::render
