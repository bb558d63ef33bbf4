# SPDX-License-Identifier: BSD-3-Clause
# skinbem_floor(NAME [HEADER_ONLY | LIBRARY] [SOURCES ...] [DEPENDS floors ...] [LINK libraries ...] [PRIVATE_LINK libraries ...])
#
# Declares one floor of the data path: the target skinbem_NAME, whose headers are included as <skinbem/NAME/...>. It is
# an OBJECT library, joined with the others into libskinbem; an INTERFACE when HEADER_ONLY; a library of its own,
# exported as skinbem::NAME, when LIBRARY. In the build tree build/include/skinbem/NAME is a link to the folder.
set(SKINBEM_BUILD_INCLUDE "${PROJECT_BINARY_DIR}/include")

function(skinbem_floor name)
  cmake_parse_arguments(ARG "HEADER_ONLY;LIBRARY" "" "SOURCES;DEPENDS;LINK;PRIVATE_LINK" ${ARGN})
  set(target skinbem_${name})

  file(MAKE_DIRECTORY "${SKINBEM_BUILD_INCLUDE}/skinbem")
  file(CREATE_LINK "${CMAKE_CURRENT_SOURCE_DIR}" "${SKINBEM_BUILD_INCLUDE}/skinbem/${name}" SYMBOLIC)

  list(TRANSFORM ARG_DEPENDS PREPEND skinbem_ OUTPUT_VARIABLE depends)
  if(ARG_HEADER_ONLY)
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  else()
    if(ARG_LIBRARY)
      add_library(${target} ${ARG_SOURCES})
      add_library(skinbem::${name} ALIAS ${target})
      set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} VERSION ${PROJECT_VERSION}
                                                 SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
      set_property(GLOBAL APPEND PROPERTY SKINBEM_LIBRARY_FLOORS ${target})
    else()
      add_library(${target} OBJECT ${ARG_SOURCES})
      set_property(GLOBAL APPEND PROPERTY SKINBEM_OBJECT_FLOORS ${target})
    endif()
    set(scope PUBLIC)
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_link_libraries(${target} PRIVATE ${ARG_PRIVATE_LINK})
    skinbem_warnings(${target})
  endif()
  target_compile_features(${target} ${scope} cxx_std_20)
  target_include_directories(${target} ${scope} "$<BUILD_INTERFACE:${SKINBEM_BUILD_INCLUDE}>"
                             "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
  target_link_libraries(${target} ${scope} ${depends} ${ARG_LINK})
  set_property(GLOBAL APPEND PROPERTY SKINBEM_FLOORS ${name})
  set_property(GLOBAL PROPERTY SKINBEM_FOLDER_OF_${name} "${CMAKE_CURRENT_SOURCE_DIR}")
endfunction()

# Warnings belong to our own targets, never to those who link us; presets turn them into errors.
function(skinbem_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion)
endfunction()
