// The operations of lanes_eight.inl on one lane, which is what a thread of the `cuda` renderer
// computes. They have the same names and give the same bits, so that the same files serve both.
// Masks have all bits set or none; sums and products of integers wrap around, as those of vectors
// do.
namespace galactic::render {
namespace {

struct IntLanes {
  std::int32_t v;
  IntLanes() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): constants stand beside vectors
  constexpr IntLanes(std::int32_t value) : v(value) {}
  GALACTIC_EVERYWHERE std::int32_t operator[](int) const { return v; }
};

struct Lanes {
  float v;
  Lanes() = default;
  constexpr explicit Lanes(float value) : v(value) {}
  GALACTIC_EVERYWHERE float operator[](int) const { return v; }
};

/// Two halves of 16 bits.
struct ShortLanes {
  std::uint32_t v;
};

/// Width of the rows in pools and of what is stored in blocks.
constexpr std::uint32_t kWidth = 8;
/// Lanes of a "vector".
constexpr std::uint32_t kLanes = 1;
constexpr std::uint32_t kBlocks = 1;
constexpr unsigned kAllLanes = 1;
constexpr std::size_t kGroupAlignment = 4;

GALACTIC_EVERYWHERE inline std::uint32_t bitsOf(IntLanes v) {
  return static_cast<std::uint32_t>(v.v);
}
GALACTIC_EVERYWHERE inline IntLanes ofBits(std::uint32_t bits) {
  return static_cast<std::int32_t>(bits);
}
GALACTIC_EVERYWHERE inline IntLanes mask(bool yes) { return yes ? -1 : 0; }

GALACTIC_EVERYWHERE inline IntLanes operator+(IntLanes a, IntLanes b) {
  return ofBits(bitsOf(a) + bitsOf(b));
}
GALACTIC_EVERYWHERE inline IntLanes operator-(IntLanes a, IntLanes b) {
  return ofBits(bitsOf(a) - bitsOf(b));
}
GALACTIC_EVERYWHERE inline IntLanes operator*(IntLanes a, IntLanes b) {
  return ofBits(bitsOf(a) * bitsOf(b));
}
GALACTIC_EVERYWHERE inline IntLanes operator-(IntLanes a) { return ofBits(0U - bitsOf(a)); }
GALACTIC_EVERYWHERE inline IntLanes operator~(IntLanes a) { return ~a.v; }
GALACTIC_EVERYWHERE inline IntLanes operator&(IntLanes a, IntLanes b) { return a.v & b.v; }
GALACTIC_EVERYWHERE inline IntLanes operator|(IntLanes a, IntLanes b) { return a.v | b.v; }
GALACTIC_EVERYWHERE inline IntLanes& operator&=(IntLanes& a, IntLanes b) { return a = a & b; }
GALACTIC_EVERYWHERE inline IntLanes& operator|=(IntLanes& a, IntLanes b) { return a = a | b; }
GALACTIC_EVERYWHERE inline IntLanes operator<<(IntLanes a, IntLanes b) {
  return ofBits(bitsOf(a) << bitsOf(b));
}
GALACTIC_EVERYWHERE inline IntLanes operator>>(IntLanes a, IntLanes b) { return a.v >> b.v; }
GALACTIC_EVERYWHERE inline IntLanes operator<(IntLanes a, IntLanes b) { return mask(a.v < b.v); }
GALACTIC_EVERYWHERE inline IntLanes operator>(IntLanes a, IntLanes b) { return mask(a.v > b.v); }
GALACTIC_EVERYWHERE inline IntLanes operator>=(IntLanes a, IntLanes b) { return mask(a.v >= b.v); }
GALACTIC_EVERYWHERE inline IntLanes operator==(IntLanes a, IntLanes b) { return mask(a.v == b.v); }
GALACTIC_EVERYWHERE inline IntLanes operator!=(IntLanes a, IntLanes b) { return mask(a.v != b.v); }

GALACTIC_EVERYWHERE inline Lanes operator+(Lanes a, Lanes b) { return Lanes(a.v + b.v); }
GALACTIC_EVERYWHERE inline Lanes operator-(Lanes a, Lanes b) { return Lanes(a.v - b.v); }
GALACTIC_EVERYWHERE inline Lanes operator*(Lanes a, Lanes b) { return Lanes(a.v * b.v); }
GALACTIC_EVERYWHERE inline Lanes operator/(Lanes a, Lanes b) { return Lanes(a.v / b.v); }
GALACTIC_EVERYWHERE inline Lanes operator-(Lanes a) { return Lanes(-a.v); }
GALACTIC_EVERYWHERE inline IntLanes operator<(Lanes a, Lanes b) { return mask(a.v < b.v); }
GALACTIC_EVERYWHERE inline IntLanes operator>(Lanes a, Lanes b) { return mask(a.v > b.v); }
GALACTIC_EVERYWHERE inline IntLanes operator<=(Lanes a, Lanes b) { return mask(a.v <= b.v); }
GALACTIC_EVERYWHERE inline IntLanes operator>=(Lanes a, Lanes b) { return mask(a.v >= b.v); }

/// All bits if the set has the only lane, otherwise none.
using LaneSet = IntLanes;
GALACTIC_EVERYWHERE inline LaneSet whereEqual(IntLanes a, IntLanes b) { return a == b; }

/// The same bits in both halves.
GALACTIC_EVERYWHERE constexpr std::uint32_t inBothHalves(std::uint32_t bits) {
  return bits | bits << 16U;
}
GALACTIC_EVERYWHERE inline ShortLanes operator>>(ShortLanes a, unsigned bits) {
  return {a.v >> bits & inBothHalves(0xFFFFU >> bits)};
}
GALACTIC_EVERYWHERE inline ShortLanes operator<<(ShortLanes a, unsigned bits) {
  return {a.v << bits & inBothHalves(0xFFFFU << bits & 0xFFFFU)};
}
GALACTIC_EVERYWHERE inline ShortLanes operator|(ShortLanes a, ShortLanes b) { return {a.v | b.v}; }

/// The same bits as another type.
template <class To, class From>
GALACTIC_EVERYWHERE inline To as(From from) {
  static_assert(sizeof(To) == sizeof(From));
  To to;
  __builtin_memcpy(&to, &from, sizeof(to));
  return to;
}

template <class Vector>
GALACTIC_EVERYWHERE inline Vector load(const void* from) {
  Vector lane;
  __builtin_memcpy(&lane, __builtin_assume_aligned(from, sizeof(lane)), sizeof(lane));
  return lane;
}

template <class Vector>
GALACTIC_EVERYWHERE inline void store(void* to, Vector lane) {
  __builtin_memcpy(__builtin_assume_aligned(to, sizeof(lane)), &lane, sizeof(lane));
}

GALACTIC_EVERYWHERE inline Lanes spread(float v) { return Lanes(v); }
GALACTIC_EVERYWHERE inline IntLanes spread(std::int32_t v) { return v; }

GALACTIC_EVERYWHERE inline Lanes toFloat(IntLanes v) { return Lanes(static_cast<float>(v.v)); }
/// Towards 0; the values lie within the range of integers.
GALACTIC_EVERYWHERE inline IntLanes toInt(Lanes v) { return static_cast<std::int32_t>(v.v); }

/// `mask`: all bits, or none.
GALACTIC_EVERYWHERE inline IntLanes pick(IntLanes mask, IntLanes yes, IntLanes no) {
  return mask.v != 0 ? yes : no;
}
GALACTIC_EVERYWHERE inline Lanes pick(IntLanes mask, Lanes yes, Lanes no) {
  return mask.v != 0 ? yes : no;
}
GALACTIC_EVERYWHERE inline IntLanes pickFrom(LaneSet set, IntLanes yes, IntLanes no) {
  return pick(set, yes, no);
}
GALACTIC_EVERYWHERE inline IntLanes laneOf(IntLanes v, int /*lane*/) { return v; }

/// Returns the second number if the comparison fails, as with NaN.
GALACTIC_EVERYWHERE inline Lanes lesser(Lanes a, Lanes b) { return a.v < b.v ? a : b; }
GALACTIC_EVERYWHERE inline Lanes greater(Lanes a, Lanes b) { return a.v > b.v ? a : b; }
GALACTIC_EVERYWHERE inline IntLanes lesser(IntLanes a, IntLanes b) { return a.v < b.v ? a : b; }
GALACTIC_EVERYWHERE inline IntLanes greater(IntLanes a, IntLanes b) { return a.v > b.v ? a : b; }

GALACTIC_EVERYWHERE inline Lanes clampTo(Lanes v, float low, float high) {
  return lesser(greater(v, spread(low)), spread(high));
}

/// The weight that blend() takes for a share within [0, 1], in 256ths.
GALACTIC_EVERYWHERE inline ShortLanes blendWeight(Lanes share) {
  return {bitsOf(toInt(share * spread(256.0F) + spread(0.5F)))};
}

/// p + (q - p) * weight / 256 for both halves, which hold bytes. One product serves both, since
/// neither half overflows into the other.
GALACTIC_EVERYWHERE inline ShortLanes blend(ShortLanes p, ShortLanes q, ShortLanes weight) {
  const std::uint32_t both = p.v * (256 - weight.v) + q.v * weight.v;
  return {(both + inBothHalves(128)) >> 8U & inBothHalves(0xFF)};
}

/// a * b / 255, rounded, for both halves, which hold bytes; those of `b` are the same.
GALACTIC_EVERYWHERE inline ShortLanes byteProducts(ShortLanes a, ShortLanes b) {
  const std::uint32_t both = a.v * (b.v & 0xFFFFU) + inBothHalves(128);
  return {(both + (both >> 8U & inBothHalves(0xFF))) >> 8U & inBothHalves(0xFF)};
}

/// A whole number in both types.
struct Whole {
  Lanes value;
  IntLanes whole;
};
/// Rounds down. The lane must be below 2^22.
GALACTIC_EVERYWHERE inline Whole roundedDown(Lanes v) {
  const IntLanes towards_0 = toInt(v);
  const IntLanes whole = towards_0 + (toFloat(towards_0) > v);
  return {toFloat(whole), whole};
}

GALACTIC_EVERYWHERE inline LaneSet setOf(unsigned bits) { return mask(bits != 0); }

GALACTIC_EVERYWHERE inline Lanes magnitude(Lanes v) {
  return as<Lanes>(as<IntLanes>(v) & 0x7FFFFFFF);
}
GALACTIC_EVERYWHERE inline float magnitude(float v) { return v < 0 ? -v : v; }

/// Bit 0: the sign.
GALACTIC_EVERYWHERE inline unsigned signBits(IntLanes v) { return bitsOf(v) >> 31U; }

/// The number of the lowest bit that is set. At least one must be.
GALACTIC_EVERYWHERE inline int lowestBit(unsigned /*bits*/) { return 0; }

GALACTIC_EVERYWHERE inline IntLanes wrapMultiply(IntLanes a, IntLanes b) { return a * b; }
GALACTIC_EVERYWHERE inline IntLanes wrapSubtract(IntLanes a, IntLanes b) { return a - b; }

GALACTIC_EVERYWHERE inline IntLanes gather(const std::int32_t* from, IntLanes at) {
  return from[at.v];
}
GALACTIC_EVERYWHERE inline Lanes gather(const float* from, IntLanes at) {
  return Lanes(from[at.v]);
}

template <class Vector>
struct Pair {
  Vector first, second;
};

/// Looks up an entry of a table, or of a table of pairs, by its number.
template <class Element>
GALACTIC_EVERYWHERE inline auto lookUp(const Element* table, IntLanes at) {
  return gather(table, at);
}
GALACTIC_EVERYWHERE inline Pair<IntLanes> lookUpPairs(const std::int32_t* table, IntLanes at) {
  return {table[2 * at.v], table[2 * at.v + 1]};
}
GALACTIC_EVERYWHERE inline Pair<Lanes> lookUpPairs(const float* table, IntLanes at) {
  return {Lanes(table[2 * at.v]), Lanes(table[2 * at.v + 1])};
}
template <class Element>
GALACTIC_EVERYWHERE inline Pair<Element> pairAt(const Element* table, std::uint32_t number) {
  return {table[2 * number], table[2 * number + 1]};
}

/// Elements at and at + 1.
GALACTIC_EVERYWHERE inline Pair<IntLanes> gatherNeighbors(const std::int32_t* from, IntLanes at) {
  return {from[at.v], from[at.v + 1]};
}

/// Element at or, if the mask `both` is set, the lesser of elements at and at + 1.
GALACTIC_EVERYWHERE inline Lanes gatherLeast(const float* from, IntLanes at, IntLanes both) {
  const Lanes first(from[at.v]);
  return both.v != 0 ? lesser(first, Lanes(from[at.v + 1])) : first;
}

/// Writes an entry of a table of pairs.
template <class Vector, class Element>
GALACTIC_EVERYWHERE inline void storePairs(Element* to, Vector first, Vector second) {
  store(to, first);
  store(to + 1, second);
}

/// Loads one number of a row. `next` is for wider vectors: where their second block lies.
template <class Element>
GALACTIC_EVERYWHERE inline IntLanes loadRows(const Element* from, std::size_t /*next*/) {
  return static_cast<std::int32_t>(*from);
}
GALACTIC_EVERYWHERE inline Lanes loadRows(const float* from, std::size_t /*next*/) {
  return Lanes(*from);
}

}  // namespace
}  // namespace galactic::render
