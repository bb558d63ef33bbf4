// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/quadrature/duffy.hpp>
