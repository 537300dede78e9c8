// What has itself loaded: nobody calls it, and the linker has to keep it all the same.
#include <cstdio>

namespace {

[[maybe_unused]] const int announced = std::puts("plugin");

}  // namespace
