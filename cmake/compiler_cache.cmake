# ccache where it is installed; a launcher given by the user stays.
#
# CCACHE_BASEDIR makes paths in the checkout relative, so that build folders and checkouts share what
# they compile alike. CCACHE_SLOPPINESS is what ccache asks for when headers are precompiled: our sources
# use neither __TIME__ nor macros that a precompiled header defines and they do not name.
find_program(GALACTIC_CCACHE ccache)
mark_as_advanced(GALACTIC_CCACHE)
if(GALACTIC_CCACHE AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}
      CCACHE_SLOPPINESS=pch_defines,time_macros ${GALACTIC_CCACHE})
endif()

# What else tells checkouts apart: the folder in __FILE__, which sources that are compiled as one name by its whole path,
# and the one in what debuggers read, with sanitizers. Reports name files from the checkout's folder on.
add_compile_options(-fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=)
if(GALACTIC_SANITIZE)
  add_compile_options(-fdebug-prefix-map=${PROJECT_SOURCE_DIR}=.)
endif()
