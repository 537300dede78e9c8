# Warnings are errors, for our own targets only; third-party headers are SYSTEM.
add_library(galactic_warnings INTERFACE)
target_compile_options(galactic_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wold-style-cast
  -Wnon-virtual-dtor -Woverloaded-virtual -Wimplicit-fallthrough -Wdouble-promotion -Werror)
# The same bytes on every machine and compiler: no contraction into fused operations.
# -fno-math-errno lets sqrt become one instruction; it changes no result.
target_compile_options(galactic_warnings INTERFACE -ffp-contract=off -fno-math-errno)

if(GALACTIC_SANITIZE)
  add_compile_options(-fsanitize=${GALACTIC_SANITIZE} -fno-omit-frame-pointer
                      -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${GALACTIC_SANITIZE})
endif()
