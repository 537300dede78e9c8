# Profile-guided optimization, with Clang (scripts/build_pgo.sh goes through the steps): programs of a build with
# GALACTIC_PGO=record count which code runs how often, into the files that LLVM_PROFILE_FILE names, and the next build lays
# its code out by what was merged of these counts. Code that was built for the record and did not run counts as cold: a
# record is to do all that has to be fast.
set(GALACTIC_PGO "" CACHE STRING
  "record (have programs count what they run), or the merged profile to optimize by (.profdata)")
if(NOT GALACTIC_PGO)
  return()
endif()
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  message(FATAL_ERROR "found GALACTIC_PGO=${GALACTIC_PGO} with ${CMAKE_CXX_COMPILER}, expected Clang: set "
    "CMAKE_CXX_COMPILER, or run scripts/build_pgo.sh, which does")
endif()

if(GALACTIC_PGO STREQUAL "record")
  # What -fprofile-generate has the compiler do, for which the compiler's cache would tell build folders apart.
  add_compile_options("SHELL:-Xclang -fprofile-instrument=llvm -Xclang -fprofile-instrument-path=default_%m.profraw")
  add_link_options(-fprofile-generate)
else()
  get_filename_component(profile ${GALACTIC_PGO} ABSOLUTE BASE_DIR ${PROJECT_SOURCE_DIR})
  if(NOT EXISTS ${profile} OR IS_DIRECTORY ${profile})
    message(FATAL_ERROR "found no profile ${profile}, which GALACTIC_PGO names: scripts/build_pgo.sh records one")
  endif()
  # Compiled anew with a new profile: the copy's name is in the command line of the compiler.
  file(GLOB earlier ${CMAKE_BINARY_DIR}/*.profdata)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${profile})
  file(SHA256 ${profile} hash)
  string(SUBSTRING ${hash} 0 16 hash)
  set(copy ${CMAKE_BINARY_DIR}/${hash}.profdata)
  list(REMOVE_ITEM earlier ${copy})
  if(earlier)
    file(REMOVE ${earlier})
  endif()
  file(COPY_FILE ${profile} ${copy} ONLY_IF_DIFFERENT)
  # Ninja compiles in this folder: by a name alone, checkouts share what they compile.
  if(CMAKE_GENERATOR STREQUAL "Ninja")
    set(copy ${hash}.profdata)
  endif()
  # Sources that changed since the record are compiled without it.
  add_compile_options(-fprofile-use=${copy}
    -Wno-profile-instr-unprofiled -Wno-profile-instr-out-of-date -Wno-backend-plugin)
  # Programs share what the linker compiles of the library.
  if(CMAKE_INTERPROCEDURAL_OPTIMIZATION)
    add_link_options(-Wl,--thinlto-cache-dir=${PROJECT_BINARY_DIR}/thinlto)
  endif()
endif()
