// SPDX-License-Identifier: BSD-3-Clause
// Kernels and quadrature without the rest of the library.
#include <skinbem/kernels/kelvin_batch.hpp>
#include <skinbem/quadrature/gauss_legendre.hpp>

int main() { return skinbem::instruction_set() != nullptr && skinbem::gauss_legendre(4).nodes.size() == 4 ? 0 : 1; }
