#pragma once

namespace galactic::bake {

/// Combines several lambdas into one callable, for std::visit.
template <class... T>
struct Overload : T... {
  using T::operator()...;
};
template <class... T>
Overload(T...) -> Overload<T...>;

}  // namespace galactic::bake
