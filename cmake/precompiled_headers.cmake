# Precompiled headers are for speed alone: every file includes what it uses, which presets with Clang check by building
# without them. There, they save little, and they hold the folder of the checkout, so that others find nothing that was
# compiled with them in the compiler's cache.
option(GALACTIC_PRECOMPILE "Precompile the third-party headers that most files include" ON)

# galactic_precompile(TARGET HEADERS...): TARGET reads HEADERS precompiled. Not for files compiled for
# another instruction set: inline functions of the headers would be compiled for it too.
function(galactic_precompile target)
  if(GALACTIC_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# galactic_precompiled_by(TARGET OTHER): TARGET shares OTHER's headers. Both need the same compile
# options and, as far as the headers use them, definitions.
function(galactic_precompiled_by target other)
  if(GALACTIC_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM ${other})
  endif()
endfunction()
