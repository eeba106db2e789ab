# Fails unless check_includes.cmake reports each of the includes planted here, and accepts a clean tree.
# Usage: cmake -DCHECKER=<check_includes.cmake> -DWORK_DIR=<scratch directory> -P self_test.cmake
function(run_checker tree result_variable output_variable)
  execute_process(COMMAND ${CMAKE_COMMAND} -DSOURCE_DIR=${tree} -P ${CHECKER}
                  RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE errors)
  set(${result_variable} ${result} PARENT_SCOPE)
  set(${output_variable} "${output}${errors}" PARENT_SCOPE)
endfunction()

# A tree with one header, with `line` in it, must be refused with a message that names the file and the header.
function(expect_refused file line header)
  file(REMOVE_RECURSE ${WORK_DIR})
  file(WRITE ${WORK_DIR}/${file} "#pragma once\n${line}\n")
  run_checker(${WORK_DIR} result output)
  if(result EQUAL 0)
    message(SEND_ERROR "'${line}' in ${file} was not reported")
  elseif(NOT output MATCHES "${file}" OR NOT output MATCHES "${header}")
    message(SEND_ERROR "the report of '${line}' does not name ${file} and ${header}:\n${output}")
  endif()
endfunction()

expect_refused(scenes/model/planted.h "#include \"mesh/zone_mesh.h\"" "mesh/zone_mesh.h")
expect_refused(mesh/planted.cpp "#include \"solver/trace/ray_scene.h\"" "solver/trace/ray_scene.h")
expect_refused(solver/shoot/planted.cpp "  #  include \"viewer_export/cli/commands.h\"" "viewer_export/cli/commands.h")
expect_refused(viewer_export/vertex/planted.h "#include \"tests/support/anything.h\"" "tests/support/anything.h")
expect_refused(solver/planted.cpp "#include \"bench/anything.h\"" "bench/anything.h")
expect_refused(solver/planted.cpp "#include <CGAL/Polygon_2.h>" "CGAL/Polygon_2.h")
expect_refused(viewer_export/vertex/planted.cpp "#include <OpenMesh/Tools/Utils/Timer.hh>" "OpenMesh/Tools/Utils/Timer.hh")
expect_refused(mesh/planted.cpp "#include <embree3/rtcore.h>" "embree3/rtcore.h")
expect_refused(viewer_export/formats/planted.cpp "#include <OpenImageIO/imageio.h>" "OpenImageIO/imageio.h")

file(REMOVE_RECURSE ${WORK_DIR})
file(WRITE ${WORK_DIR}/viewer_export/cli/clean.cpp "#include <vector>\n#include \"scenes/model/scene.h\"\n")
file(WRITE ${WORK_DIR}/solver/trace/clean.cpp "#include <embree3/rtcore.h>\n#include \"mesh/zone_mesh.h\"\n")
run_checker(${WORK_DIR} result output)
if(NOT result EQUAL 0)
  message(SEND_ERROR "a clean tree was refused:\n${output}")
endif()
file(REMOVE_RECURSE ${WORK_DIR})
