# ccache where it is installed; a launcher given by the user stays.
find_program(GALACTIC_CCACHE ccache)
mark_as_advanced(GALACTIC_CCACHE)
if(GALACTIC_CCACHE AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${GALACTIC_CCACHE})
endif()
