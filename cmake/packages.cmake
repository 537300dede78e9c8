# `cpack -G DEB` in the build folder: packages for Debian, one for each component of install.cmake.
set(CPACK_PACKAGE_VENDOR "The galactic authors")
set(CPACK_PACKAGE_CONTACT "The galactic authors <galactic@galactic.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Batch simulation and rendering of robots in furnished homes")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_COMPONENTS_ALL dev)
if(TARGET galactic-run)
  list(APPEND CPACK_COMPONENTS_ALL run)
endif()
if(TARGET galactic-bake)
  list(APPEND CPACK_COMPONENTS_ALL bake)
endif()
if(TARGET galactic_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE zstd)

set(CPACK_DEBIAN_RUN_PACKAGE_NAME galactic)
set(CPACK_DEBIAN_RUN_DESCRIPTION "Batch simulation and rendering of robots in furnished homes
 galactic-run steps and draws thousands of homes at once from packs;
 galactic-pack inspects, checks, compares and exports packs.")
set(CPACK_DEBIAN_RUN_PACKAGE_RECOMMENDS "libegl1, galactic-bake")
set(CPACK_DEBIAN_RUN_PACKAGE_SUGGESTS "ffmpeg, python3-galactic")

set(CPACK_DEBIAN_BAKE_PACKAGE_NAME galactic-bake)
set(CPACK_DEBIAN_BAKE_DESCRIPTION "Makes packs for galactic of scenes, objects and robots
 galactic-bake turns scene meshes, scans, objects and robots (URDF, MJCF) into packs:
 column grids, oriented boxes, sphere sets, kinematics, render meshes, episodes.")
set(CPACK_DEBIAN_BAKE_PACKAGE_RECOMMENDS galactic)

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libgalactic-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_DESCRIPTION "Library for batch simulation and rendering of robots in homes
 The static library, its headers, examples, a CMake package
 (find_package(galactic), galactic::runtime) and a file for pkg-config.")
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS 
  "libfmt-dev (>= ${fmt_VERSION}), libfmt-dev (<< ${GALACTIC_NEXT_FMT}), libexpected-dev")
if(GALACTIC_HAS_GL)
  string(APPEND CPACK_DEBIAN_DEV_PACKAGE_DEPENDS ", libepoxy-dev")
endif()

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-galactic)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "Vector environments and training for robots in furnished homes
 Python bindings of galactic, environments after Gymnasium, and a trainer.")
# The module is of one version of Python.
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3-numpy")
if(GALACTIC_PYTHON_FOLDER MATCHES "python3[.]([0-9]+)")
  math(EXPR next_minor "${CMAKE_MATCH_1} + 1")
  string(APPEND CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
         ", python3 (>= 3.${CMAKE_MATCH_1}), python3 (<< 3.${next_minor})")
endif()
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-torch, python3-pil, ffmpeg")
include(CPack)
