# SPDX-License-Identifier: BSD-3-Clause
# TetGen::TetGen, for the Debian package libtet1.5-dev, which brings neither a CMake package nor a pkg-config file.
find_library(TETGEN_LIBRARY tet)
find_path(TETGEN_INCLUDE_DIR tetgen.h)
mark_as_advanced(TETGEN_LIBRARY TETGEN_INCLUDE_DIR)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(TetGen REQUIRED_VARS TETGEN_LIBRARY TETGEN_INCLUDE_DIR)
if(TetGen_FOUND AND NOT TARGET TetGen::TetGen)
  add_library(TetGen::TetGen UNKNOWN IMPORTED)
  set_target_properties(TetGen::TetGen PROPERTIES IMPORTED_LOCATION "${TETGEN_LIBRARY}"
                                                  INTERFACE_INCLUDE_DIRECTORIES "${TETGEN_INCLUDE_DIR}")
endif()
