// SPDX-License-Identifier: BSD-3-Clause
#include <cblas.h>
#include <fmt/format.h>
#include <omp.h>

#include <skinbem/kernels/kelvin_batch.hpp>

#include "commands.hpp"

void add_info(CLI::App& program) {
  CLI::App* command = program.add_subcommand("info", "Version, instruction set, BLAS, threads");
  command->callback([] {
    fmt::print("skinbem          {}\ninstruction set  {}\nBLAS             {} ({})\nthreads          {}\n",
               SKINBEM_VERSION, skinbem::instruction_set(), openblas_get_config(), openblas_get_corename(),
               omp_get_max_threads());
  });
}
