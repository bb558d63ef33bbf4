#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# run_commands.sh ROOT DOCUMENT FOLDER BIN: runs the ```sh blocks of a document, in their order, as one script, in a new
# FOLDER that has the project's data/, with the programs of BIN in the path.
set -euo pipefail
root=$1 document=$2 folder=$3 bin=$4
blocks=$(realpath "$(dirname "$0")")/blocks.awk
count=$(awk -v language=sh -f "$blocks" "$root/$document")
[[ $count -gt 0 ]] || { echo "$document: no commands"; exit 0; }
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"
ln -s "$root/data" data
for ((i = 1; i <= count; ++i)); do awk -v language=sh -v number="$i" -f "$blocks" "$root/$document"; done >commands
PATH=$bin:$PATH bash -euxo pipefail commands
