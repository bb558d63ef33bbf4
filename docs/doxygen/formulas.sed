# SPDX-License-Identifier: BSD-3-Clause
# From GitHub's marks of formulas to Doxygen's.
s/^\$\$ /\\f[ /
s/ \$\$$/ \\f]/
s/\$\([^$]*\)\$/\\f$\1\\f$/g
