# What cmake --install does beside the program: the library, its headers, and a package by which CMake finds it.
include(CMakePackageConfigHelpers)
include(CheckCXXSourceCompiles)

# What others link.
add_library(reemit_library INTERFACE)
target_link_libraries(reemit_library INTERFACE reemit_viewer_export)
set_target_properties(reemit_library PROPERTIES EXPORT_NAME reemit)
foreach(part flags scenes mesh solver viewer_export)
  set_target_properties(reemit_${part} PROPERTIES EXPORT_NAME ${part})
endforeach()

# Our headers include each other from the root of the source tree, others include <reemit/solver/...>: both work.
target_include_directories(reemit_flags INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
                           $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/reemit>)

# How Eigen allocates depends on the vector instructions a file is compiled for, and what a program allocates our
# libraries may free. So programs that are compiled for wider vectors allocate as our libraries do; where those are
# compiled with flags that make Eigen something else, programs get the same flags.
set(CMAKE_REQUIRED_LIBRARIES Eigen3::Eigen)
check_cxx_source_compiles("#include <Eigen/Core>\nstatic_assert(EIGEN_MAX_ALIGN_BYTES == 16); int main() {}"
                          REEMIT_EIGEN_ALIGNS_TO_16)
unset(CMAKE_REQUIRED_LIBRARIES)
if(REEMIT_EIGEN_ALIGNS_TO_16)
  target_compile_definitions(reemit_flags INTERFACE $<INSTALL_INTERFACE:EIGEN_MAX_ALIGN_BYTES=16>
                             $<INSTALL_INTERFACE:EIGEN_MALLOC_ALREADY_ALIGNED=$<NOT:$<BOOL:${REEMIT_SANITIZE}>>>)
else()
  separate_arguments(flags NATIVE_COMMAND "${CMAKE_CXX_FLAGS}")
  target_compile_options(reemit_flags INTERFACE "$<INSTALL_INTERFACE:${flags}>")
endif()

# The manual page and messages point to the pages by name.
file(GLOB pages CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/docs/*.md ${PROJECT_SOURCE_DIR}/docs/*.bib)
install(FILES LICENSE README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES ${pages} DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs)

# Left out: the command line, and headers that show libraries which only our own code links (the test install.example
# notices one more of them).
install(DIRECTORY scenes mesh solver viewer_export DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/reemit
        FILES_MATCHING PATTERN *.h
        PATTERN cli EXCLUDE
        PATTERN library EXCLUDE
        REGEX "/scenes/io/(common/json_cursor|gltf/gltf_(accessors|document|draco|draco_mesh|extensions|materials|meshes|meshopt|model|nodes|texture))\\.h$" EXCLUDE
        REGEX "/scenes/io/native/native_(ies_light|materials|objects|shapes|sky|textures|transform|view)\\.h$" EXCLUDE
        REGEX "/solver/(solution/(audit_group|gather_plan_group|hdf5_[a-z_]+|texture_group)|trace/embree_(queries|tree))\\.h$" EXCLUDE
        REGEX "/viewer_export/formats/glb_file\\.h$" EXCLUDE)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/generated/reemit/version.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/reemit)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/reemit)
install(TARGETS reemit_library reemit_viewer_export reemit_solver reemit_mesh reemit_scenes reemit_flags
        EXPORT reemit ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT reemit NAMESPACE reemit:: FILE reemitTargets.cmake DESTINATION ${package_dir})
configure_package_config_file(cmake/reemitConfig.cmake.in reemitConfig.cmake INSTALL_DESTINATION ${package_dir}
                              PATH_VARS REEMIT_INSTALL_MODULE_DIR)
# Before 1.0 every minor version may change what others use.
write_basic_package_version_file(reemitConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/reemitConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/reemitConfigVersion.cmake
        DESTINATION ${package_dir})
