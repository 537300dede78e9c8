#pragma once

namespace galactic::bake {

/// One call operator of several lambdas, for std::visit.
template <class... T>
struct Overload : T... {
  using T::operator()...;
};
template <class... T>
Overload(T...) -> Overload<T...>;

}  // namespace galactic::bake
