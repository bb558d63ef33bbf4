#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# check_document.sh ROOT DOCUMENT: each ```cpp block stands, line for line, in the example that the comment above it
# names (<!-- examples/NAME.cpp -->), and each relative link leads to a file.
set -euo pipefail
cd "$1"
document=$2
blocks=$(dirname "$0")/blocks.awk
flat() { sed 's/^[ \t]*//; s/[ \t]*$//' | grep -v '^$' | tr '\n' '\036'; }
faults=0
fault() { echo "$document: $1" >&2; faults=1; }

count=$(awk -v language=cpp -f "$blocks" "$document")
mapfile -t files < <(grep -B1 '^```cpp$' "$document" | sed -n 's/^<!-- \(.*\) -->$/\1/p')
[[ ${#files[@]} -eq $count ]] || fault "a cpp block without <!-- examples/NAME.cpp --> above it"
for ((i = 1; i <= ${#files[@]}; ++i)); do
  text=$(awk -v language=cpp -v number="$i" -f "$blocks" "$document" | flat | tr -d '\0')
  [[ $(flat <"${files[i - 1]}") == *"$text"* ]] || fault "cpp block $i differs from ${files[i - 1]}"
done

while read -r link; do
  [[ -e $(dirname "$document")/$link ]] || fault "no file $link"
done < <(grep -o '](\([^)]*\))' "$document" | sed 's/^](//; s/)$//; s/#.*//' | grep -v -e '^[a-z]*:' -e '^$' || true)
exit $faults
