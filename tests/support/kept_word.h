#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "galactic/column_grid.h"

namespace galactic::test {

/// What a grid says to be free, and what it says when it is asked. Counts its cases.
class KeptWord {
 public:
  explicit KeptWord(const ColumnGrid& grid) : grid_(grid) {}

  /// Asks in every column: at the ends of its spans and inside, at the distances to contact and on
  /// the way there, and just beyond the spans.
  void askEveryColumn() {
    for (std::uint32_t k = 0; k < grid_.columnsZ(); ++k) {
      for (std::uint32_t i = 0; i < grid_.columnsX(); ++i) askColumn(i, k);
      askTogether();
    }
  }

  /// The first broken word; empty: all were kept.
  [[nodiscard]] const std::string& broken() const { return broken_; }
  [[nodiscard]] std::size_t spans() const { return spans_; }
  [[nodiscard]] std::size_t free() const { return free_; }
  [[nodiscard]] std::size_t blocked() const { return blocked_; }

 private:
  void askColumn(std::uint32_t i, std::uint32_t k) {
    const ColumnGridLayout& layout = grid_.layout();
    column_ = {layout.min_x + (static_cast<float>(i) + 0.5F) * layout.spacing, 0,
               layout.min_z + (static_cast<float>(k) + 0.5F) * layout.spacing};
    spans_of_column_.resize(grid_.spanCount(i, k));
    grid_.spans(i, k, spans_of_column_);
    spans_ += spans_of_column_.size();
    for (const Span& span : spans_of_column_) {
      for (const float part : {0.0F, 1e-6F, 0.01F, 0.5F, 0.99F, 1.0F}) {
        askFrom(std::clamp(span.lo + part * (span.hi - span.lo), span.lo, span.hi));
      }
      // More than rounding could explain.
      const float beyond = 2 * layout.quantum + 1e-5F * (layout.heights.hi - layout.heights.lo);
      for (const float outside : {span.lo - beyond, span.hi + beyond}) {
        blocked_ += clearanceAt(outside) != Clearance::kFree ? 1U : 0U;
      }
    }
  }

  [[nodiscard]] Vec3 at(float y) const { return {column_.x, y, column_.z}; }
  [[nodiscard]] Clearance clearanceAt(float y) const { return grid_.clearance(at(y)); }

  /// The place is free, and so is what its distances lead to.
  void askFrom(float y) {
    expectFree(y, "in a span");
    const Contact contact = grid_.contact(at(y));
    for (const float part : {0.0F, 0.3F, 1.0F}) {
      expectFree(y - part * contact.down, "on the way down");
      expectFree(y + part * contact.up, "on the way up");
    }
    add(y);
    add(y - contact.down);
    add(y + contact.up);
  }

  void expectFree(float y, const char* place) {
    ++free_;
    if (clearanceAt(y) == Clearance::kFree || !broken_.empty()) return;
    broken_ = fmt::format("({}, {}, {}) {} is not free", column_.x, y, column_.z, place);
  }

  void add(float y) {
    x_.push_back(column_.x);
    y_.push_back(y);
    z_.push_back(column_.z);
  }

  /// The same of the batched queries.
  void askTogether() {
    clearance_.resize(x_.size());
    down_.resize(x_.size());
    up_.resize(x_.size());
    grid_.contact({x_, y_, z_}, {clearance_, down_, up_});
    for (std::size_t n = 0; n < x_.size() && broken_.empty(); ++n) {
      if (clearance_[n] == Clearance::kFree) continue;
      broken_ = fmt::format("({}, {}, {}) is not free in a batch", x_[n], y_[n], z_[n]);
    }
    const SphereCenters centers{x_, y_, z_};
    if (grid_.firstNotFree(centers) != x_.size() && broken_.empty()) {
      broken_ = "firstNotFree finds one";
    }
    for (std::size_t n = 0; n < y_.size(); ++n) y_[n] -= down_[n];
    grid_.contact({x_, y_, z_}, {clearance_, {}, {}});
    const bool is_kept = std::all_of(clearance_.begin(), clearance_.end(),
                                     [](Clearance answer) { return answer == Clearance::kFree; });
    if (!is_kept && broken_.empty()) broken_ = "the batch's way down leads to a contact";
    for (std::vector<float>* values : {&x_, &y_, &z_}) values->clear();
  }

  const ColumnGrid& grid_;
  Vec3 column_;
  std::vector<Span> spans_of_column_;
  std::vector<float> x_, y_, z_, down_, up_;
  std::vector<Clearance> clearance_;
  std::string broken_;
  std::size_t spans_ = 0;
  std::size_t free_ = 0;
  std::size_t blocked_ = 0;
};

}  // namespace galactic::test
