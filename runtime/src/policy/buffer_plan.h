#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace galactic::policy {

/// Number of a buffer in a plan.
using BufferId = std::uint32_t;

/// Where the values of a network lie while it runs: buffers that are not needed at the same time
/// share memory. Operations are numbered in the order in which they run.
class BufferPlan {
 public:
  /// A buffer of `size` floats per env that operation `operation` fills.
  BufferId add(std::size_t size, std::size_t operation);
  /// The same for an operation that goes through `source` element by element, which it reads last:
  /// it may work in place.
  BufferId addLike(BufferId source, std::size_t operation);
  /// Operation `operation` reads the buffer.
  void read(BufferId buffer, std::size_t operation);

  /// Gives all buffers their places: no more calls of the above.
  void place();

  /// Floats per env; of each buffer from where on, and how many, padded to whole lanes.
  [[nodiscard]] std::size_t total() const { return total_; }
  [[nodiscard]] std::size_t offset(BufferId buffer) const { return buffers_[buffer].offset; }
  [[nodiscard]] std::size_t stride(BufferId buffer) const { return buffers_[buffer].size; }

 private:
  struct Buffer {
    std::size_t size = 0;
    std::size_t first_use = 0;
    std::size_t last_use = 0;
    std::size_t offset = 0;
    /// What it would like to replace; itself when nothing.
    BufferId source = 0;
  };

  [[nodiscard]] std::size_t findGap(const Buffer& buffer, const std::vector<BufferId>& alive) const;

  std::vector<Buffer> buffers_;
  std::size_t total_ = 0;
};

}  // namespace galactic::policy
