// Operations on vectors of any width, lane by lane. Included after lanes_eight.inl or
// lanes_sixteen.inl.
namespace galactic::simulation {
namespace {

inline Lanes pick(IntLanes mask, Lanes yes, Lanes no) { return mask ? yes : no; }

/// Returns `a` if neither is less, as vminps and vmaxps do with their operands swapped.
inline Lanes lesser(Lanes a, Lanes b) { return b < a ? b : a; }
inline Lanes greater(Lanes a, Lanes b) { return b > a ? b : a; }

/// The nearest whole number for |value| < 2^22.
inline Lanes rounded(Lanes value) {
  const Lanes shift = spread(12582912.0F);  // 1.5 * 2^23: leaves no bits for a fraction
  return (value + shift) - shift;
}

}  // namespace
}  // namespace galactic::simulation
