#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Sets up (scripts/setup.sh), configures the release preset and builds it into build/release.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh
cmake --preset release
cmake --build --preset release -- -j "$(nproc)"
