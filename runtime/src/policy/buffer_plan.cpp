#include "policy/buffer_plan.h"

#include <algorithm>

#include "policy/kernels.h"

namespace galactic::policy {

BufferId BufferPlan::add(std::size_t size, std::size_t operation) {
  const auto id = static_cast<BufferId>(buffers_.size());
  buffers_.push_back({.size = (size + kLane - 1) / kLane * kLane,
                      .first_use = operation,
                      .last_use = operation,
                      .offset = 0,
                      .source = id});
  return id;
}

BufferId BufferPlan::addLike(BufferId source, std::size_t operation) {
  const BufferId id = add(buffers_[source].size, operation);
  buffers_[id].source = source;
  return id;
}

void BufferPlan::read(BufferId buffer, std::size_t operation) {
  buffers_[buffer].last_use = std::max(buffers_[buffer].last_use, operation);
}

void BufferPlan::place() {
  // By ascending offset.
  std::vector<BufferId> alive;
  for (BufferId id = 0; id < buffers_.size(); ++id) {
    Buffer& buffer = buffers_[id];
    const Buffer& source = buffers_[buffer.source];
    const bool replaces = buffer.source != id && source.last_use == buffer.first_use;
    if (replaces) {
      buffer.offset = source.offset;
      *std::ranges::find(alive, buffer.source) = id;
      continue;
    }
    std::erase_if(alive,
                  [&](BufferId other) { return buffers_[other].last_use < buffer.first_use; });
    buffer.offset = findGap(buffer, alive);
    total_ = std::max(total_, buffer.offset + buffer.size);
    const auto behind = std::ranges::find_if(
        alive, [&](BufferId other) { return buffers_[other].offset > buffer.offset; });
    alive.insert(behind, id);
  }
}

std::size_t BufferPlan::findGap(const Buffer& buffer, const std::vector<BufferId>& alive) const {
  std::size_t offset = 0;
  for (const BufferId other : alive) {
    if (offset + buffer.size <= buffers_[other].offset) break;
    offset = std::max(offset, buffers_[other].offset + buffers_[other].size);
  }
  return offset;
}

}  // namespace galactic::policy
