# Warnings are errors, for our own targets only; third-party headers are SYSTEM.
add_library(galactic_warnings INTERFACE)
target_compile_options(galactic_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wold-style-cast
  -Wnon-virtual-dtor -Woverloaded-virtual -Wimplicit-fallthrough -Wdouble-promotion -Werror)
# The same bytes on every machine and compiler: no contraction into fused operations.
# -fno-math-errno lets sqrt become one instruction; it changes no result.
target_compile_options(galactic_warnings INTERFACE -ffp-contract=off -fno-math-errno)
# It takes a source that another one includes for a header, where such a type would be a mistake.
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(galactic_warnings INTERFACE -Wno-subobject-linkage)
endif()

# Tests are compiled for longer than they run: in Release, -O1 takes a third less to compile than -O3, and
# no result depends on it. Not for programs: the linker keeps one copy of an inline function, which could
# be the slower one.
add_library(galactic_not_hot INTERFACE)
target_compile_options(galactic_not_hot INTERFACE $<$<CONFIG:Release>:-O1>)

if(GALACTIC_SANITIZE)
  add_compile_options(-fsanitize=${GALACTIC_SANITIZE} -fno-omit-frame-pointer
                      -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${GALACTIC_SANITIZE})
endif()
