#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Sets up, builds and runs the demo; arguments go to `skinbem demo` (for example -o DIR).
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/build.sh
exec build/release/bin/skinbem demo "$@"
