# Many files are compiled as one: what they include is then read once, and templates that they share are made once, which
# is most of the time that a single file takes. So functions in anonymous namespaces of one library that have the same name
# must take parameters that no compiler could confuse. What is large is split, so that all cores have work; the preset dev
# compiles each file alone and so notices what a file forgets to include.
set(REEMIT_UNITY_FILES 45 CACHE STRING "Files that are compiled as one, at most")

function(reemit_unite target)
  get_target_property(files ${target} SOURCES)
  list(LENGTH files count)
  math(EXPR units "(${count} + ${REEMIT_UNITY_FILES} - 1) / ${REEMIT_UNITY_FILES}")
  set(i 0)
  foreach(file ${files})
    math(EXPR unit "${i} * ${units} / ${count}")
    set_source_files_properties(${file} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${unit})
    math(EXPR i "${i} + 1")
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # GCC takes a file that another includes for a header, and warns of anonymous types in its classes.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()

# Every library and program of these folders.
function(reemit_unite_folders)
  foreach(folder ${ARGN})
    get_property(targets DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} PROPERTY BUILDSYSTEM_TARGETS)
    foreach(target ${targets})
      get_target_property(type ${target} TYPE)
      if(type MATCHES "STATIC_LIBRARY|MODULE_LIBRARY|EXECUTABLE")
        reemit_unite(${target})
      endif()
    endforeach()
  endforeach()
endfunction()

reemit_unite_folders(scenes mesh solver viewer_export)
if(REEMIT_BENCH)
  reemit_unite_folders(bench bench/validation bench/hit_paths)
endif()
if(REEMIT_TESTS)
  reemit_unite_folders(tests)
endif()
