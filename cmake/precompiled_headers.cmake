# Headers of libraries that most files include take longer to compile than our own code. They are compiled once
# instead: one set for libraries, programs and benchmarks, one for tests. mesh/ has a set of its own, for CGAL rounds with
# flags of its own. Only headers of others may be here: ours change too often, and a file must say itself what it
# needs (the presets dev and sanitize compile without this and so notice what is missing). CLI11 and nlohmann-json are
# left out: what they instantiate would be compiled again in every file, which costs more than reading them where needed.
set(REEMIT_COMMON_HEADERS
    <algorithm> <array> <atomic> <cmath> <cstdint> <filesystem> <fstream> <functional> <limits> <map> <memory> <numbers>
    <numeric> <optional> <set> <span> <sstream> <stdexcept> <string> <string_view> <utility> <variant> <vector>
    <Eigen/Core> <Eigen/Geometry> <fmt/format.h>)

# An object library that owns precompiled headers, compiled as its users are.
function(reemit_add_headers name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "LINK;HEADERS")
  file(GENERATE OUTPUT ${CMAKE_BINARY_DIR}/generated/${name}.cpp CONTENT "")
  add_library(${name} OBJECT ${CMAKE_BINARY_DIR}/generated/${name}.cpp)
  target_link_libraries(${name} PRIVATE reemit_flags ${arg_LINK})
  target_precompile_headers(${name} PRIVATE ${REEMIT_COMMON_HEADERS} ${arg_HEADERS})
endfunction()

# Every target of these folders compiles with the headers of `owner`, EXCEPT those that do not link what they include or
# are optimised otherwise.
function(reemit_reuse_headers owner)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "EXCEPT")
  foreach(folder ${arg_UNPARSED_ARGUMENTS})
    get_property(targets DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} PROPERTY BUILDSYSTEM_TARGETS)
    foreach(target ${targets})
      get_target_property(type ${target} TYPE)
      if(type MATCHES "STATIC_LIBRARY|EXECUTABLE" AND NOT target IN_LIST arg_EXCEPT)
        target_precompile_headers(${target} REUSE_FROM ${owner})
      endif()
    endforeach()
  endforeach()
endfunction()

reemit_add_headers(reemit_headers
  LINK Eigen3::Eigen fmt::fmt TBB::tbb
  HEADERS <tbb/blocked_range.h> <tbb/parallel_for.h> <tbb/task_arena.h>)
reemit_reuse_headers(reemit_headers scenes solver viewer_export EXCEPT reemit_cli)
target_precompile_headers(reemit_mesh PRIVATE ${REEMIT_COMMON_HEADERS})
if(REEMIT_BENCH)
  reemit_reuse_headers(reemit_headers bench bench/validation bench/hit_paths
                       EXCEPT reemit_bench_curve reemit_bench_options reemit_validation)
endif()
