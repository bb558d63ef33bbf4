# SPDX-License-Identifier: BSD-3-Clause
# What `cmake --install` writes: libraries, headers by floor, the skinbem program, data, and how others find it all
# (CMake package and pkg-config file).
include(CMakePackageConfigHelpers)

get_property(floors GLOBAL PROPERTY SKINBEM_FLOORS)
get_property(library_floors GLOBAL PROPERTY SKINBEM_LIBRARY_FLOORS)
set(package_folder "${CMAKE_INSTALL_LIBDIR}/cmake/skinbem")

install(TARGETS skinbem ${library_floors} EXPORT skinbem)
foreach(floor IN LISTS floors)
  get_property(folder GLOBAL PROPERTY SKINBEM_FOLDER_OF_${floor})
  install(DIRECTORY "${folder}/" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/skinbem/${floor}" FILES_MATCHING PATTERN "*.hpp"
          PATTERN "*-inl.hpp" EXCLUDE)
endforeach()
install(DIRECTORY "${PROJECT_SOURCE_DIR}/data/" DESTINATION "${CMAKE_INSTALL_DATADIR}/skinbem"
        PATTERN make EXCLUDE)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}")

install(EXPORT skinbem FILE skinbem-targets.cmake NAMESPACE skinbem:: DESTINATION "${package_folder}")
if(BUILD_SHARED_LIBS)
  set(SKINBEM_SHARED ON)
else()
  set(SKINBEM_SHARED OFF)
endif()
configure_package_config_file(cmake/skinbem-config.cmake.in "${PROJECT_BINARY_DIR}/skinbem-config.cmake"
                              INSTALL_DESTINATION "${package_folder}" NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/skinbem-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/skinbem-config.cmake" "${PROJECT_BINARY_DIR}/skinbem-config-version.cmake"
              "${PROJECT_SOURCE_DIR}/cmake/FindCHOLMOD.cmake" DESTINATION "${package_folder}")

file(RELATIVE_PATH pc_prefix "${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_PREFIX}")
# A static library leaves its own libraries to those who link it; a shared one brings them.
set(pc_needs "openblas libhwy libpng")
set(pc_libs "${OpenMP_CXX_FLAGS}")
if(SKINBEM_WITH_CHOLMOD)
  string(APPEND pc_libs " -lcholmod")
endif()
if(BUILD_SHARED_LIBS)
  set(pc_requires "Requires.private: ${pc_needs}")
  set(pc_libs "Libs.private: ${pc_libs}")
else()
  set(pc_requires "Requires: eigen3 ${pc_needs}")
endif()
configure_file(cmake/skinbem.pc.in "${PROJECT_BINARY_DIR}/skinbem.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/skinbem.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
