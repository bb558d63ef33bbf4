// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// With which words bad input is refused.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include <skinbem/base/error.hpp>

namespace skinbem::testing_support {

/// The message of the Error(bad_input) that a call throws; "no error" where it throws none.
template <class Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    return error.what();
  }
  return "no error";
}

}  // namespace skinbem::testing_support
