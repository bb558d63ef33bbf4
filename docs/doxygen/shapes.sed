# SPDX-License-Identifier: BSD-3-Clause
# "#V by 3" is a shape, not a link.
/\/\/\//s/#\([A-Za-z]\)/\\#\1/g
