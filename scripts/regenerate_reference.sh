#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Integrates the reference values of tests/reference again, in quadruple precision. Needs libboost-dev; takes minutes.
set -euo pipefail
cd "$(dirname "$0")/.."
cmake --preset release -DSKINBEM_BUILD_ORACLE=ON
cmake --build --preset release --target oracle
build/release/bin/oracle cases tests/reference/quadrature_cases.csv
build/release/bin/oracle meshes tests/reference
