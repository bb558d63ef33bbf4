#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Makes the lower limb anew, into the folder above or the one given. Needs python3 and python3-numpy.
set -eu
exec "${PYTHON:-/usr/bin/python3}" "$(dirname "$0")/make.py" "$@"
