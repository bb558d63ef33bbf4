// SPDX-License-Identifier: BSD-3-Clause
#include "quadrature_cases.hpp"

#include <algorithm>
#include <limits>
#include <skinbem/base/text.hpp>
#include <string_view>
#include <unordered_map>

namespace skinbem {
namespace {

/// One table of text, addressed by column name.
class Table {
 public:
  explicit Table(const std::filesystem::path& path) : file_(path) {
    if (file_.lines().empty()) file_.fail(0, "the table is empty; its first line names the columns");
    const auto names = split(file_.lines()[0], ',');
    for (std::size_t i = 0; i < names.size(); ++i)
      if (!columns_.emplace(trimmed(names[i]), i).second)
        file_.fail(1, "column '" + std::string(names[i]) + "' appears twice");
  }

  std::size_t line_count() const { return file_.lines().size(); }

  /// Makes line `line` (from 1) the current row; false when it is blank.
  bool go_to(std::size_t line) {
    line_ = line;
    if (trimmed(file_.lines()[line - 1]).empty()) return false;
    cells_ = split(file_.lines()[line - 1], ',');
    if (cells_.size() != columns_.size())
      fail("has " + std::to_string(cells_.size()) + " cells, the header names " + std::to_string(columns_.size()));
    return true;
  }

  std::string_view text(const std::string& column) const {
    const auto found = columns_.find(column);
    if (found == columns_.end()) file_.fail(1, "column '" + column + "' is missing");
    return trimmed(cells_[found->second]);
  }

  double number(const std::string& column) const {
    const auto value = parse_number(text(column));
    if (!value) fail("column '" + column + "': '" + std::string(text(column)) + "' is not a finite number");
    return *value;
  }

  [[noreturn]] void fail(const std::string& what) const { file_.fail(line_, what); }

 private:
  TextFile file_;
  std::unordered_map<std::string, std::size_t> columns_;
  std::vector<std::string_view> cells_;
  std::size_t line_ = 0;
};

/// For example U0_11.
std::string entry_name(char kernel, int vertex, int row, int column) {
  std::string name = "U0_11";
  name[0] = kernel;
  name[1] = static_cast<char>('0' + vertex);
  name[3] = static_cast<char>('1' + row);
  name[4] = static_cast<char>('1' + column);
  return name;
}

/// False when all nine cells are blank.
bool read_block(const Table& table, char kernel, int vertex, Eigen::Matrix3d& block) {
  int blanks = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) blanks += table.text(entry_name(kernel, vertex, i, j)).empty() ? 1 : 0;
  if (blanks == 9) return false;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) block(i, j) = table.number(entry_name(kernel, vertex, i, j));
  return true;
}

Eigen::Vector3d read_point(const Table& table, const std::string& prefix) {
  return {table.number(prefix + "x"), table.number(prefix + "y"), table.number(prefix + "z")};
}

QuadratureCase read_case(const Table& table, std::size_t line) {
  QuadratureCase c;
  c.line = line;
  c.id = table.text("id");
  c.group = table.text("class");
  c.poisson = table.number("nu");
  if (!(c.poisson > -1 && c.poisson <= 0.5)) table.fail("nu must be in (-1, 0.5]");
  for (int v = 0; v < 3; ++v) {
    c.vertices[v] = read_point(table, std::array{"v0", "v1", "v2"}[v]);
    if (!read_block(table, 'U', v, c.exact.U[v])) table.fail("the block of " + entry_name('U', v, 0, 0) + " is blank");
    c.has_T[v] = read_block(table, 'T', v, c.exact.T[v]);
  }
  c.x = read_point(table, "x");
  c.condition_U = table.number("condU");
  c.condition_T = table.number("condT");
  if (c.condition_U < 0 || c.condition_T < 0) table.fail("condU and condT must not be negative");
  return c;
}

double relative_error(const Eigen::Matrix3d& exact, const Eigen::Matrix3d& result) {
  const double scale = exact.cwiseAbs().maxCoeff();
  const double error = (result - exact).cwiseAbs().maxCoeff();
  if (!result.allFinite()) return std::numeric_limits<double>::infinity();
  return scale > 0 ? error / scale : error;
}

}  // namespace

std::vector<QuadratureCase> read_quadrature_cases(const std::filesystem::path& path) {
  Table table(path);
  std::vector<QuadratureCase> cases;
  for (std::size_t line = 2; line <= table.line_count(); ++line)
    if (table.go_to(line)) cases.push_back(read_case(table, line));
  if (cases.empty()) {
    table.go_to(1);
    table.fail("the table has no rows");
  }
  return cases;
}

double error_of_U(const QuadratureCase& c, const ElementBlocks& result) {
  double worst = 0;
  for (int v = 0; v < 3; ++v) worst = std::max(worst, relative_error(c.exact.U[v], result.U[v]));
  return worst;
}

double error_of_T(const QuadratureCase& c, const ElementBlocks& result) {
  double worst = 0;
  for (int v = 0; v < 3; ++v)
    if (c.has_T[v]) worst = std::max(worst, relative_error(c.exact.T[v], result.T[v]));
  return worst;
}

double longest_edge(const QuadratureCase& c) {
  const auto& v = c.vertices;
  return std::max({(v[1] - v[0]).norm(), (v[2] - v[1]).norm(), (v[0] - v[2]).norm()});
}

}  // namespace skinbem
