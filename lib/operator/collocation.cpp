// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/operator/collocation_impl.hpp>

namespace skinbem {

template class Collocation<Kelvin<double>>;
template class Collocation<Laplace<double>>;

}  // namespace skinbem
