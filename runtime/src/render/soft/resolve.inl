// From what is seen at each pixel to the images, a vector of pixels at a time: one block where it
// has eight lanes, two that lie side by side where it has sixteen.
namespace galactic::render {
namespace {

/// The records of as many pixels as there are lanes, field by field.
struct EachRecord {
  Lanes fields[kRecordFields];
  Lanes field(std::uint32_t number) const { return fields[number]; }
  IntLanes intField(std::uint32_t number) const { return as<IntLanes>(fields[number]); }
};

inline EachRecord loadColors(const float* records, const std::int32_t* ids) {
  static_assert(kRecordFields == kColorFields);
  EachRecord each;
  for (std::uint32_t n = 0; n < kRecordFields; n += 4) {
    gatherFour<kRecordStride>(records + n, ids, each.fields + n);
  }
  return each;
}

/// Pixels of one triangle.
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

/// Pixels of several triangles.
inline IntLanes shadeMixed(const Pane& pane, const std::int32_t* ids, const PixelLanes& pixels) {
  const auto id = load<IntLanes>(ids);
  const float* records = pane.scratch->records;
  EachRecord each;
  gatherFour<kRecordStride>(records + kTexels, ids, each.fields + kTexels);
  const IntLanes kind = each.intField(kKind);
  IntLanes colors = each.intField(kTexels);
  const IntLanes flat = (kind & 0xFF) == spread(static_cast<std::int32_t>(kFlatSurface));
  if (signBits(flat) != kAllLanes) {
    gatherFour<kRecordStride>(records + kURight, ids, each.fields + kURight);
    gatherFour<kRecordStride>(records + kURight + 4, ids, each.fields + kURight + 4);
    colors = sampleTexels(*pane.task, texturePlaces(each, pixels));
  }
  if (signBits(kind) != 0) {
    // Lanes without colors look at record 0.
    alignas(kVectorBytes) std::int32_t colored[kLanes];
    store(colored, id & (kind >> 31));
    const EachRecord planes = loadColors(pane.scratch->colors, colored);
    colors = pick(kind >> 31, timesColors(colors, planes, pixels), colors);
  }
  const IntLanes lit = kind << 1;
  if (signBits(lit) != 0) {
    Lanes light[4];
    gatherFour<kRecordStride>(records + kLightRight, ids, light);
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

/// Where the pixels of one or two blocks lie in the whole image, and how many are within.
struct BlockTarget {
  std::size_t pixel;
  std::uint32_t width, height;
};
constexpr std::uint32_t kBlocks = kLanes / kWidth;

inline BlockTarget blockTarget(const PaneTask& task, std::uint32_t column, std::uint32_t row) {
  const std::uint32_t x = column * kBlockWidth;
  const std::uint32_t y = row * kBlockHeight;
  constexpr std::uint32_t kWide = kBlocks * kBlockWidth;
  const std::uint32_t wide = task.width - x < kWide ? task.width - x : kWide;
  const std::uint32_t high = task.height - y < kBlockHeight ? task.height - y : kBlockHeight;
  return {static_cast<std::size_t>(task.top + y) * task.image_width + task.left + x, wide, high};
}

/// Writes elements of four bytes to an image.
inline void writeWords(const PaneTask& task, const BlockTarget& target, void* image,
                       IntLanes words) {
  auto* to = static_cast<std::uint8_t*>(image) + 4 * target.pixel;
  alignas(kVectorBytes) std::uint8_t bytes[4 * kLanes];
  store(bytes, words);
  constexpr std::size_t kRowBytes = std::size_t{4} * kBlockWidth;
  for (std::uint32_t y = 0; y < target.height; ++y, to += std::size_t{4} * task.image_width) {
    for (std::uint32_t block = 0; block < kBlocks; ++block) {
      const std::uint32_t x = block * kBlockWidth;
      const std::uint8_t* from = bytes + kRowBytes * (2 * block + y);
      if (target.width >= x + kBlockWidth) {
        __builtin_memcpy(to + std::size_t{4} * x, from, kRowBytes);
      } else if (target.width > x) {
        __builtin_memcpy(to + std::size_t{4} * x, from, std::size_t{4} * (target.width - x));
      }
    }
  }
}

/// The place of a lane's pixel among those of its blocks.
constexpr std::uint32_t laneX(std::uint32_t lane) {
  return lane % kBlockWidth + lane / kWidth * kBlockWidth;
}
constexpr std::uint32_t laneY(std::uint32_t lane) { return lane / kBlockWidth % kBlockHeight; }

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

/// Puts what the image has already in the place of pixels that are shaded.
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

inline void resolveColors(const Pane& pane, const BlockTarget& target, const std::int32_t* ids,
                          const PixelLanes& pixels) {
  const PaneTask& task = *pane.task;
  const auto id = load<IntLanes>(ids);
  const bool any_shaded = signBits(id) != 0;
  alignas(kVectorBytes) std::int32_t valid[kLanes];
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
inline void resolve(const Pane& pane) {
  const PaneTask& task = *pane.task;
  const float* depth = pane.scratch->depth;
  const std::int32_t* ids = pane.scratch->ids;
  const std::uint32_t shown_columns = (task.width + kBlockWidth - 1) / kBlockWidth;
  const std::uint32_t shown_rows = (task.height + kBlockHeight - 1) / kBlockHeight;
  for (std::uint32_t row = 0; row < shown_rows; ++row) {
    for (std::uint32_t column = 0; column < shown_columns; column += kBlocks) {
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
inline void makeRoom(Pane& pane) {
  const PaneTask& task = *pane.task;
  for (std::uint32_t row = 0; row < pane.rows; ++row) {
    for (std::uint32_t column = 0; column < pane.columns; column += kBlocks) {
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
