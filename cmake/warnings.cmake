# Warnings are errors, for our own targets only; third-party headers are SYSTEM. Where galactic is part of another
# project, its compiler may be one that warns of more: they stay warnings.
add_library(galactic_warnings INTERFACE)
target_compile_options(galactic_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wold-style-cast
  -Wnon-virtual-dtor -Woverloaded-virtual -Wimplicit-fallthrough -Wdouble-promotion
  $<$<BOOL:${GALACTIC_WERROR}>:-Werror>)
# The same bytes on every machine and compiler: no contraction into fused operations.
# -fno-math-errno lets sqrt become one instruction; it changes no result.
target_compile_options(galactic_warnings INTERFACE -ffp-contract=off -fno-math-errno)
# It takes a source that another one includes for a header, where such a type would be a mistake.
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(galactic_warnings INTERFACE -Wno-subobject-linkage)
endif()

# GCC collects its garbage later: it takes a tenth less time, and a fourth more memory.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(galactic_warnings INTERFACE --param=ggc-min-heapsize=524288)
endif()

# What is compiled for longer than it runs: in Release, -O1 takes half as long to compile as -O3, and no result depends
# on it.
add_library(galactic_not_hot INTERFACE)
target_compile_options(galactic_not_hot INTERFACE $<$<CONFIG:Release>:-O1>)

# So is what reads command lines and writes texts. Where sanitizers watch, -O0 compiles it in a third to half of the time
# of -O1.
# A program has one copy of an inline function: those that hot code shares with this make strings, paths and errors.
add_library(galactic_cold INTERFACE)
target_link_libraries(galactic_cold INTERFACE galactic_not_hot)

# Most tests are run once for each time that they are compiled.
add_library(galactic_run_once INTERFACE)
target_compile_options(galactic_run_once INTERFACE -O0)

if(GALACTIC_SANITIZE)
  target_compile_options(galactic_cold INTERFACE -O0)
  add_compile_options(-fsanitize=${GALACTIC_SANITIZE} -fno-omit-frame-pointer
                      -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${GALACTIC_SANITIZE})
endif()
