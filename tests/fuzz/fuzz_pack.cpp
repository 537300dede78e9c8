// Any bytes as a pack. An even first byte: the rest is the file as it is. An odd one: the rest is
// the payload, and a header with its right size and hash is put before it, so that the checks
// behind the hash are reached. What opens has to answer queries safely and alike, one by one and in
// batches.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <vector>

#include "galactic/pack.h"
#include "galactic/scene.h"
#include "support/aligned_bytes.h"

namespace {

using namespace galactic;

[[noreturn]] void report(const char* finding) {
  std::fprintf(stderr, "finding: %s\n", finding);
  std::abort();
}

/// Centres over, beside and beyond a grid.
struct Centres {
  std::vector<float> x, y, z;

  explicit Centres(const ColumnGrid& grid) {
    const ColumnGridLayout& layout = grid.layout();
    const float height = layout.heights.hi - layout.heights.lo;
    const std::uint32_t step_x = std::max(1U, layout.columns_x / 16);
    const std::uint32_t step_z = std::max(1U, layout.columns_z / 16);
    for (std::uint32_t k = 0; k <= layout.columns_z && k + step_z > k; k += step_z) {
      for (std::uint32_t i = 0; i <= layout.columns_x && i + step_x > i; i += step_x) {
        for (const float part : {-0.1F, 0.0F, 0.3F, 0.7F, 1.0F}) {
          add(layout.min_x + (static_cast<float>(i) + 0.5F) * layout.spacing,
              layout.heights.lo + part * height,
              layout.min_z + (static_cast<float>(k) + 0.5F) * layout.spacing);
        }
      }
    }
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    add(kNan, 0, 0);
    add(kInfinity, -kInfinity, kInfinity);
  }

  void add(float at_x, float at_y, float at_z) {
    x.push_back(at_x);
    y.push_back(at_y);
    z.push_back(at_z);
  }
};

bool sameBits(float a, float b) { return std::memcmp(&a, &b, sizeof(a)) == 0; }

void query(const ColumnGrid& grid) {
  const Centres centres(grid);
  std::vector<Clearance> clearance(centres.x.size());
  std::vector<float> down(centres.x.size());
  std::vector<float> up(centres.x.size());
  grid.contact({centres.x, centres.y, centres.z}, {clearance, down, up});
  for (std::size_t n = 0; n < centres.x.size(); ++n) {
    const Contact contact = grid.contact({centres.x[n], centres.y[n], centres.z[n]});
    const bool same = contact.clearance == clearance[n] && sameBits(contact.down, down[n]) &&
                      sameBits(contact.up, up[n]);
    if (!same) report("the batched query differs from the scalar one");
    if (!(contact.down >= 0 && contact.up >= 0)) report("a negative or undefined distance");
  }
  std::vector<Span> spans(grid.spanCount(grid.columnsX() - 1, grid.columnsZ() - 1));
  grid.spans(grid.columnsX() - 1, grid.columnsZ() - 1, spans);
}

test::AlignedBytes fileOf(const std::uint8_t* data, std::size_t size) {
  const auto* first = reinterpret_cast<const std::byte*>(data);
  std::vector<std::byte> file(first + 1, first + size);
  if (data[0] % 2 == 1) {
    const PackHeader header = makePackHeader(PackKind::kScene, file);
    const auto* bytes = reinterpret_cast<const std::byte*>(&header);
    file.insert(file.begin(), bytes, bytes + sizeof(header));
  }
  return test::AlignedBytes(file);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const test::AlignedBytes file = fileOf(data, size);
  const auto pack = PackFile::view(file.bytes(), "fuzz.pack");
  if (!pack) {
    if (pack.error().where.empty() || pack.error().message.empty()) {
      report("an error without place or message");
    }
    return 0;
  }
  const auto scene = Scene::from(*pack);
  if (!scene) return 0;
  for (const ColumnGrid& grid : scene->grids()) query(grid);
  return 0;
}
