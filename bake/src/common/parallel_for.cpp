#include "galactic/bake/parallel_for.h"

#include "support/threads/workers.h"

namespace galactic::bake {

void parallelFor(unsigned threads, std::size_t count,
                 const std::function<void(std::size_t)>& body) {
  detail::forEachPart(threads, count, body);
}

}  // namespace galactic::bake
