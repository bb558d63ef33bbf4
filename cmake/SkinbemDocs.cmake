# SPDX-License-Identifier: BSD-3-Clause
# The target `docs`: reference and documents as HTML in docs/html of the build folder, where Doxygen is installed.
find_program(DOXYGEN_EXECUTABLE doxygen)
mark_as_advanced(DOXYGEN_EXECUTABLE)
if(DOXYGEN_EXECUTABLE)
  configure_file("${PROJECT_SOURCE_DIR}/docs/doxygen/Doxyfile.in" "${PROJECT_BINARY_DIR}/docs/Doxyfile" @ONLY)
  add_custom_target(docs COMMAND "${DOXYGEN_EXECUTABLE}" "${PROJECT_BINARY_DIR}/docs/Doxyfile"
                    COMMENT "Doxygen into ${PROJECT_BINARY_DIR}/docs/html" VERBATIM)
endif()
