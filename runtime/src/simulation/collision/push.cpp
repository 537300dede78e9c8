#include "simulation/collision/push.h"

#include <algorithm>
#include <cmath>

namespace galactic::simulation {

void PushSum::add(const Push& push) noexcept {
  least_x_ = std::min(least_x_, push.x);
  most_x_ = std::max(most_x_, push.x);
  least_z_ = std::min(least_z_, push.z);
  most_z_ = std::max(most_z_, push.z);
}

Push PushSum::total(float longest) const noexcept {
  const Push sum{least_x_ + most_x_, least_z_ + most_z_};
  const float length = std::sqrt(sum.x * sum.x + sum.z * sum.z);
  if (!(length > longest)) return sum;
  return {sum.x * (longest / length), sum.z * (longest / length)};
}

}  // namespace galactic::simulation
