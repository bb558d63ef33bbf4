// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <skinbem/base/atomic_file.hpp>
#include <skinbem/base/error.hpp>

#include "../../bench/quadrature_cases.hpp"
#include "files.hpp"

namespace skinbem {
namespace {

class QuadratureCases : public testing::Test {
 protected:
  /// The project's table up to its second row, with `from` replaced by `to`.
  std::filesystem::path changed(const std::string& from, const std::string& to) {
    std::string text = read_file(testing_support::project_file("tests/reference/quadrature_cases.csv"));
    text.resize(text.find('\n', text.find('\n', text.find('\n') + 1) + 1) + 1);
    const std::size_t place = text.find(from);
    EXPECT_NE(place, std::string::npos) << from;
    text.replace(place, from.size(), to);
    const auto path = folder_ / "cases.csv";
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }

  void expect_refused(const std::filesystem::path& path, const std::string& message) {
    try {
      read_quadrature_cases(path);
      FAIL() << "accepted; expected: " << message;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_input);
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  }

  testing_support::TemporaryFolder folder_;
};

TEST_F(QuadratureCases, ReadTheProjectsOwnTable) {
  const auto cases = read_quadrature_cases(testing_support::project_file("tests/reference/quadrature_cases.csv"));
  EXPECT_GT(cases.size(), 100u);
  for (const QuadratureCase& c : cases) {
    const bool at_vertex = c.group == "at_vertex";
    EXPECT_EQ(c.has_T[0] && c.has_T[1] && c.has_T[2], !at_vertex) << c.id;
    EXPECT_EQ(error_of_U(c, c.exact), 0.0);
    EXPECT_EQ(error_of_T(c, c.exact), 0.0);
  }
}

TEST_F(QuadratureCases, NameTheLineAndWhatIsWrong) {
  expect_refused(changed("condT", "cond"), "cases.csv:1: column 'condT' is missing");
  expect_refused(changed("condT", "condU"), "cases.csv:1: column 'condU' appears twice");
  expect_refused(changed("\ne1,", "\ne1,extra,"), "cases.csv:2: has 81 cells, the header names 80");
  expect_refused(changed("\ne2,", "\ne2,extra,"), "cases.csv:3: has 81 cells");
  const auto path = folder_ / "empty.csv";
  std::ofstream(path) << "";
  expect_refused(path, "empty.csv: the table is empty");
}

TEST_F(QuadratureCases, RefuseCellsThatAreNotNumbers) {
  const auto original = read_quadrature_cases(changed("condT", "condT")).front();
  std::string text = read_file(folder_ / "cases.csv");
  const std::size_t row = text.find('\n') + 1, last = text.rfind(',', text.find('\n', row));
  for (const char* cell : {"nan", "inf", "1e999", "abc", "", "1.0x"}) {
    std::string broken = text;
    broken.replace(last + 1, text.find('\n', row) - last - 1, cell);
    std::ofstream(folder_ / "cases.csv", std::ios::binary) << broken;
    expect_refused(folder_ / "cases.csv", "cases.csv:2: column 'condT'");
  }
  EXPECT_EQ(original.line, 2u);
}

TEST_F(QuadratureCases, AreAnInputOutputErrorWhenMissing) {
  try {
    read_quadrature_cases(folder_ / "missing.csv");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::io);
  }
}

TEST_F(QuadratureCases, CountNotANumberAsInfinitelyWrong) {
  const auto c = read_quadrature_cases(changed("condT", "condT")).front();
  ElementBlocks result = c.exact;
  result.U[1](0, 2) = result.T[2](1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(error_of_U(c, result), std::numeric_limits<double>::infinity());
  EXPECT_EQ(error_of_T(c, result), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace skinbem
