# SPDX-License-Identifier: BSD-3-Clause
# cmake -P check_includes.cmake ROOT: fails where a file of a floor includes a floor above its own in the data path, or
# includes <skinbem/...> in another form than <skinbem/FLOOR/...>.
cmake_minimum_required(VERSION 3.25)
get_filename_component(root "${CMAKE_ARGV3}" ABSOLUTE)

# Every floor may include itself and what it is given here. Kernels and quadrature are siblings that know nothing else.
set(below kernels quadrature)
set(may_kernels kernels)
set(may_quadrature quadrature)
foreach(floor IN ITEMS base mesh operator hmatrix solve response frame motion io apps)
  list(APPEND below ${floor})
  set(may_${floor} ${below})
endforeach()

file(GLOB_RECURSE files RELATIVE "${root}" "${root}/kernels/*.?pp" "${root}/quadrature/*.?pp" "${root}/lib/*.?pp"
     "${root}/apps/*.?pp")
if(NOT files)
  message(FATAL_ERROR "no source file found in ${root}")
endif()
set(faults "")
foreach(file IN LISTS files)
  string(REGEX REPLACE "^(lib/)?([^/]+)/.*" "\\2" floor "${file}")
  if(NOT DEFINED may_${floor})
    string(APPEND faults "\n${file}: floor ${floor} is not in the data path; give it its place in tests/structure")
    continue()
  endif()
  file(STRINGS "${root}/${file}" includes REGEX "^[ \t]*#[ \t]*include")
  foreach(include IN LISTS includes)
    if(include MATCHES "include[ \t]*\"" AND NOT floor STREQUAL "apps")  # apps is no floor that others include
      string(APPEND faults "\n${file}: write <skinbem/${floor}/...> instead of ${include}")
    elseif(include MATCHES "<skinbem/([^/>]+)/" AND NOT CMAKE_MATCH_1 IN_LIST may_${floor})
      string(APPEND faults "\n${file}: floor ${floor} must not include floor ${CMAKE_MATCH_1}")
    endif()
  endforeach()
endforeach()
if(faults)
  message(FATAL_ERROR "${faults}")
endif()
