# cmake -DFILES=a.glsl;b.glsl -DOUTPUT=texts.h -DNAMESPACE=x::y -DPREFIX=kShader -P embed_texts.cmake
#
# Writes a header in which each file is a string: shaders/cull_test.glsl becomes x::y::kShaderCullTest.
set(text "// Made of files by cmake/embed_texts.cmake.\n#pragma once\n\nnamespace ${NAMESPACE} {\n\n")
foreach(file IN LISTS FILES)
  get_filename_component(words ${file} NAME_WE)
  string(REPLACE "_" ";" words ${words})
  set(name ${PREFIX})
  foreach(word IN LISTS words)
    string(SUBSTRING ${word} 0 1 initial)
    string(SUBSTRING ${word} 1 -1 rest)
    string(TOUPPER ${initial} initial)
    string(APPEND name ${initial}${rest})
  endforeach()
  file(READ ${file} content)
  string(APPEND text "inline constexpr const char* ${name} = R\"text(${content})text\";\n\n")
endforeach()
string(APPEND text "}  // namespace ${NAMESPACE}\n")
file(WRITE ${OUTPUT} "${text}")
