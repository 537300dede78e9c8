# Where CMAKE_UNITY_BUILD is on: compiles as one the sources that can be (scripts/source_groups.py finds out which).
# To be included when all targets are known. Sources whose names changed want a new configuration.
if(NOT CMAKE_UNITY_BUILD)
  return()
endif()
find_package(Python3 REQUIRED COMPONENTS Interpreter)

# Appends to the list `lists` of the caller a text "target;source;..." for each target of the folder and below.
function(galactic_list_sources folder)
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    get_target_property(sources ${target} SOURCES)
    list(FILTER sources INCLUDE REGEX "^[^$]*\\.cpp$")
    if(sources)
      list(TRANSFORM sources PREPEND "${folder}/" REGEX "^[^/]")
      set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
      string(APPEND lists "${target};${sources}\n")
    endif()
  endforeach()
  get_property(subfolders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(subfolder IN LISTS subfolders)
    galactic_list_sources(${subfolder})
  endforeach()
  set(lists "${lists}" PARENT_SCOPE)
endfunction()

set(lists "")
galactic_list_sources(${PROJECT_SOURCE_DIR})
set(GALACTIC_UNITY_GROUPS ${PROJECT_BINARY_DIR}/unity_groups)
file(WRITE ${GALACTIC_UNITY_GROUPS}.txt "${lists}")
execute_process(
  COMMAND ${Python3_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/scripts/source_groups.py
          ${GALACTIC_UNITY_GROUPS}.txt ${GALACTIC_UNITY_GROUPS}.cmake
  COMMAND_ERROR_IS_FATAL ANY)
include(${GALACTIC_UNITY_GROUPS}.cmake)
