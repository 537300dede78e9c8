#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace galactic::policy {

/// Index of a buffer in a plan.
using BufferId = std::uint32_t;

/// Where the values of a network lie while it runs: buffers that are not needed at the same time
/// share memory. Operations are numbered in the order in which they run.
class BufferPlan {
 public:
  /// Adds a buffer of `size` floats per env that operation `operation` fills.
  BufferId add(std::size_t size, std::size_t operation);
  /// The same for an operation that goes through `source` element by element: if it is the last one
  /// to read `source`, it works in place.
  BufferId addLike(BufferId source, std::size_t operation);
  /// Operation `operation` reads the buffer.
  void read(BufferId buffer, std::size_t operation);

  /// Assigns all buffers their places. Call none of the above afterwards.
  void place();

  /// Floats per env in total; for a buffer its offset and its size, padded to whole lanes.
  [[nodiscard]] std::size_t total() const { return total_; }
  [[nodiscard]] std::size_t offset(BufferId buffer) const { return buffers_[buffer].offset; }
  [[nodiscard]] std::size_t stride(BufferId buffer) const { return buffers_[buffer].size; }

 private:
  struct Buffer {
    std::size_t size = 0;
    std::size_t first_use = 0;
    std::size_t last_use = 0;
    std::size_t offset = 0;
    /// The buffer that this one may replace; itself if none.
    BufferId source = 0;
  };

  [[nodiscard]] std::size_t findGap(const Buffer& buffer, const std::vector<BufferId>& alive) const;

  std::vector<Buffer> buffers_;
  std::size_t total_ = 0;
};

}  // namespace galactic::policy
