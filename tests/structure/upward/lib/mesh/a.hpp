// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/response/response_model.hpp>
