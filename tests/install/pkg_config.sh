#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# pkg_config.sh LIBDIR COMPILER OUTPUT VERSION [FLAGS ...]: builds and runs the consumer by what pkg-config says.
set -euo pipefail
libdir=$1 compiler=$2 output=$3 version=$4
shift 4
export PKG_CONFIG_PATH=$libdir/pkgconfig
[[ $(pkg-config --modversion skinbem) == "$version" ]]
# shellcheck disable=SC2046
"$compiler" -std=c++20 "$@" "$(dirname "$0")/consumer.cpp" $(pkg-config --cflags --libs skinbem) -o "$output"
LD_LIBRARY_PATH=$libdir "$output"
