#include "galactic/bake/parallel_for.h"

#include "support/workers.h"

namespace galactic::bake {

void parallelFor(unsigned jobs, std::size_t count, const std::function<void(std::size_t)>& body) {
  detail::forEachPart(jobs, count, body);
}

}  // namespace galactic::bake
