# SPDX-License-Identifier: BSD-3-Clause
# awk -v language=NAME [-v number=N] -f blocks.awk DOCUMENT: prints how many fenced blocks of that language there are,
# or the text of the N-th.
/^```/ {
  if (inside) { inside = 0 } else { inside = 1; wanted = ($0 == "```" language); if (wanted) ++count }
  next
}
inside && wanted && count == number { print }
END { if (!number) print count + 0 }
