// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// oracle: writes the reference values that the tests compare with, in quadruple precision.
#include <cstring>
#include <exception>
#include <iostream>

#include "case_table.hpp"
#include "mesh_reference.hpp"

int main(int argc, char** argv) {
  using namespace skinbem::oracle;
  try {
    if (argc == 3 && std::strcmp(argv[1], "cases") == 0) {
      write_case_table(argv[2]);
    } else if (argc == 3 && std::strcmp(argv[1], "meshes") == 0) {
      write_mesh_references(argv[2]);
    } else if (argc == 3 && std::strcmp(argv[1], "compare") == 0) {
      compare_case_table(argv[2]);
    } else if (argc == 3 && std::strcmp(argv[1], "compare-mesh") == 0) {
      compare_mesh(argv[2]);
    } else {
      std::cerr << "usage: oracle cases FILE.csv | meshes FOLDER | compare FILE.csv | compare-mesh PREFIX\n";
      return 2;
    }
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
