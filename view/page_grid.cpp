#include "view/page_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace galactic {
namespace {

/// The columns as numbers that compress well: each span relative to that of the column before.
class ColumnCoder {
 public:
  ColumnCoder(float low, float quantum) : low_(low), quantum_(quantum) {}

  void add(std::span<const Span> spans) {
    counts_.push_back(static_cast<std::uint16_t>(spans.size()));
    codes_.clear();
    for (const Span& span : spans) {
      codes_.push_back(codeOf(span.lo));
      codes_.push_back(codeOf(span.hi));
    }
    for (std::size_t n = 0; n < codes_.size(); ++n) {
      const std::uint16_t before = n < before_.size() ? before_[n] : std::uint16_t{0};
      differences_.push_back(static_cast<std::uint16_t>(codes_[n] - before));
    }
    before_.swap(codes_);
  }

  [[nodiscard]] const std::vector<std::uint16_t>& counts() const { return counts_; }
  [[nodiscard]] const std::vector<std::uint16_t>& differences() const { return differences_; }

 private:
  [[nodiscard]] std::uint16_t codeOf(float height) const {
    constexpr double kMost = std::numeric_limits<std::uint16_t>::max();
    const double code = std::round((static_cast<double>(height) - static_cast<double>(low_)) /
                                   static_cast<double>(quantum_));
    return static_cast<std::uint16_t>(std::clamp(code, 0.0, kMost));
  }

  float low_;
  float quantum_;
  std::vector<std::uint16_t> counts_;
  std::vector<std::uint16_t> differences_;
  std::vector<std::uint16_t> codes_;
  std::vector<std::uint16_t> before_;
};

}  // namespace

void writeGrid(const ColumnGrid& grid, JsonWriter& json, PageData& data) {
  constexpr float kMostCodes = 65535;
  const ColumnGridLayout& layout = grid.layout();
  const float range = layout.heights.hi - layout.heights.lo;
  const float quantum = std::max(layout.quantum, range / kMostCodes);
  ColumnCoder coder(layout.heights.lo, quantum);
  std::vector<Span> spans;
  for (std::uint32_t k = 0; k < grid.columnsZ(); ++k) {
    for (std::uint32_t i = 0; i < grid.columnsX(); ++i) {
      spans.resize(grid.spanCount(i, k));
      grid.spans(i, k, spans);
      coder.add(spans);
    }
  }
  Chunk chunk;
  chunk.addPlanes("counts", coder.counts());
  chunk.addPlanes("differences", coder.differences());
  json.begin("", '{');
  json.number("radius", grid.radius());
  json.number("spacing", grid.spacing());
  json.number("min_x", layout.min_x);
  json.number("min_z", layout.min_z);
  json.number("columns_x", grid.columnsX());
  json.number("columns_z", grid.columnsZ());
  json.number("low", layout.heights.lo);
  json.number("high", layout.heights.hi);
  json.number("quantum", quantum);
  json.number("spans", coder.differences().size() / 2);
  data.add(json, "data", chunk);
  json.end('}');
}

}  // namespace galactic
