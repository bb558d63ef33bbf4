#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs what skinbem needs on Debian 12: as root, or through sudo; else prints the one line to run.
set -euo pipefail

packages=(
  g++ cmake ninja-build pkg-config git
  libeigen3-dev libsuitesparse-dev libopenblas-openmp-dev libhwy-dev
  libcli11-dev nlohmann-json3-dev libfmt-dev libpng-dev
  libbenchmark-dev libgtest-dev libgmock-dev
)

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f '${Status}' "$package" 2>/dev/null || true)
  [[ $status == "install ok installed" ]] || missing+=("$package")
done
[[ ${#missing[@]} -eq 0 ]] && exit 0

install="apt-get install -y --no-install-recommends ${missing[*]}"
if [[ $(id -u) -eq 0 ]]; then
  as_root=()
elif command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
  as_root=(sudo)
else
  echo "skinbem needs some Debian packages. Please run:" >&2
  echo "  sudo apt-get update && sudo $install" >&2
  exit 1
fi
echo "Installing: ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive $install
