// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The subcommands. Each adds itself to the program; its callback does the work and throws skinbem::Error.
#pragma once

#include <CLI/CLI.hpp>

void add_demo(CLI::App& program);
void add_check(CLI::App& program);
void add_response(CLI::App& program);
void add_animate(CLI::App& program);
void add_info(CLI::App& program);
