// Shifts the spheres of one env, eight numbers at a time. Included after lanes_eight.inl.
namespace galactic::simulation {
namespace {

inline void addToAll(float* to, std::size_t count, float by) {
  const Lanes each = spread(by);
  for (std::size_t n = 0; n < count; n += kLanes) store(to + n, load(to + n) + each);
}

void shiftKernel(const SphereShift& given) noexcept {
  // A copy, so that the compiler knows that no write below changes it.
  const SphereShift shift = given;
  const std::size_t spheres = shift.sphere_count;
  addToAll(shift.centers, spheres, shift.by_x);
  // Most floors are flat.
  if (shift.by_y != 0) addToAll(shift.centers + spheres, spheres, shift.by_y);
  addToAll(shift.centers + 2 * spheres, spheres, shift.by_z);
  // Rounding is monotonic, so the bounds of shifted spheres are the shifted bounds.
  const std::size_t two_bounds = 2 * shift.group_count;
  addToAll(shift.bounds, two_bounds, shift.by_x);
  addToAll(shift.bounds + two_bounds, two_bounds, shift.by_y);
  addToAll(shift.bounds + 2 * two_bounds, two_bounds, shift.by_z);
  const Lanes of_extents{shift.by_x, shift.by_x, shift.by_y, shift.by_y, shift.by_z, shift.by_z};
  store(shift.extents, load(shift.extents) + of_extents);
}

}  // namespace
}  // namespace galactic::simulation
