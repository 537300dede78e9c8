# What `cmake --install` and `cpack` put where: a component for each Debian package.
#
#   run     galactic           galactic-run, galactic-pack, their man pages and completions
#   bake    galactic-bake      galactic-bake, galactic-dynamics, and the recipes of robots and worlds
#   dev     libgalactic-dev    libgalactic, its headers, a CMake package, a file for pkg-config, examples
#   python  python3-galactic   the Python package (python/CMakeLists.txt)
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(GALACTIC_TOOLS "")
if(TARGET galactic-run)
  install(TARGETS galactic-run galactic-pack COMPONENT run)
  list(APPEND GALACTIC_TOOLS galactic-run galactic-pack)
endif()
if(TARGET galactic-bake)
  install(TARGETS galactic-bake galactic-dynamics COMPONENT bake)
  # The sample world's sources stay in the source tree.
  install(DIRECTORY packs/robots packs/worlds DESTINATION ${CMAKE_INSTALL_DATADIR}/galactic COMPONENT bake
          PATTERN sample.toml EXCLUDE)
  list(APPEND GALACTIC_TOOLS galactic-bake galactic-dynamics)
endif()

# The library. Targets that link it find what it needs through the CMake package.
set(GALACTIC_PACKAGE_FOLDER ${CMAKE_INSTALL_LIBDIR}/cmake/galactic)
set_target_properties(galactic PROPERTIES EXPORT_NAME runtime)
install(TARGETS galactic EXPORT galacticTargets COMPONENT dev INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY runtime/include/galactic DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)
install(EXPORT galacticTargets NAMESPACE galactic:: DESTINATION ${GALACTIC_PACKAGE_FOLDER} COMPONENT dev)
math(EXPR GALACTIC_NEXT_FMT "${fmt_VERSION_MAJOR} + 1")
configure_package_config_file(cmake/galacticConfig.cmake.in ${PROJECT_BINARY_DIR}/galacticConfig.cmake
  INSTALL_DESTINATION ${GALACTIC_PACKAGE_FOLDER} NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/galacticConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/galacticConfig.cmake ${PROJECT_BINARY_DIR}/galacticConfigVersion.cmake
  DESTINATION ${GALACTIC_PACKAGE_FOLDER} COMPONENT dev)

# For builds without CMake. The prefix is found from where the file lies: cmake --install may be given another one.
cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX BASE_DIRECTORY ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig
  OUTPUT_VARIABLE GALACTIC_PREFIX_FROM_PC)
foreach(folder IN ITEMS LIBDIR INCLUDEDIR)
  # Some distributions give them as absolute paths.
  set(GALACTIC_PC_${folder} ${CMAKE_INSTALL_${folder}})
  if(NOT IS_ABSOLUTE "${CMAKE_INSTALL_${folder}}")
    string(PREPEND GALACTIC_PC_${folder} "\${prefix}/")
  endif()
endforeach()
set(GALACTIC_PC_EPOXY "")
if(GALACTIC_HAS_GL)
  set(GALACTIC_PC_EPOXY " -Wl,--push-state,--as-needed,-lepoxy,--pop-state")
endif()
configure_file(cmake/galactic.pc.in ${PROJECT_BINARY_DIR}/galactic.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/galactic.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)
install(DIRECTORY examples/cpp/ DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/libgalactic-dev/examples COMPONENT dev)

# Man pages come from --help, so that they say what the tools do.
find_program(GALACTIC_HELP2MAN help2man)
mark_as_advanced(GALACTIC_HELP2MAN)
set(GALACTIC_PACK_VERBS info check column diff export picture report view)
set(man_pages "")

# galactic_man_page(PAGE TOOL [VERB]): the target man_pages makes man/PAGE.1 of what TOOL [VERB] --help says.
function(galactic_man_page page tool)
  string(JOIN " " command ${tool} ${ARGN})
  set(file ${PROJECT_BINARY_DIR}/man/${page}.1)
  add_custom_command(OUTPUT ${file}
    COMMAND ${Python3_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/scripts/man_page.py --help2man ${GALACTIC_HELP2MAN}
            --tool $<TARGET_FILE:${tool}> --version ${PROJECT_VERSION} -o ${file} ${ARGN}
    DEPENDS ${tool} ${PROJECT_SOURCE_DIR}/scripts/man_page.py
    COMMENT "Man page of ${command}" VERBATIM)
  set(component run)
  if(tool MATCHES "^galactic-(bake|dynamics)$")
    set(component bake)
  endif()
  install(FILES ${file} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${component})
  set(man_pages ${man_pages} ${file} PARENT_SCOPE)
endfunction()

if(NOT GALACTIC_TOOLS)
  message(STATUS "No programs are built: no man pages")
elseif(CMAKE_CROSSCOMPILING)
  message(STATUS "Programs are for another system: no man pages")
elseif(GALACTIC_HELP2MAN AND NOT GALACTIC_SANITIZE)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  foreach(tool IN LISTS GALACTIC_TOOLS)
    galactic_man_page(${tool} ${tool})
  endforeach()
  foreach(verb IN LISTS GALACTIC_PACK_VERBS)
    galactic_man_page(galactic-pack-${verb} galactic-pack ${verb})
  endforeach()
  add_custom_target(man_pages ALL DEPENDS ${man_pages})
else()
  message(STATUS "No help2man found (Debian: help2man), or a build with sanitizers: no man pages")
endif()

# bash-completion loads the file that is named like the command.
foreach(tool IN LISTS GALACTIC_TOOLS)
  set(component run)
  if(tool MATCHES "^galactic-(bake|dynamics)$")
    set(component bake)
  endif()
  install(FILES scripts/completion.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
    RENAME ${tool} COMPONENT ${component})
endforeach()

# The license, where Debian's packages have it; the Python package brings its own, also in a wheel.
function(galactic_install_license component package)
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/${package} RENAME copyright
    COMPONENT ${component})
endfunction()
galactic_install_license(dev libgalactic-dev)
if(TARGET galactic-run)
  galactic_install_license(run galactic)
endif()
if(TARGET galactic-bake)
  galactic_install_license(bake galactic-bake)
endif()

include(cmake/packages.cmake)
