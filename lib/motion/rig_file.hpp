// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The rig file's tables and values, before their meaning: a layer over CLI11's TOML reader that knows lines.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <skinbem/base/text.hpp>
#include <skinbem/base/types.hpp>

namespace skinbem {

/// What is asked for is ticked off; what nobody asked for is an error in the end, so that no misspelt key is lost.
class RigFile {
 public:
  struct Value {
    std::vector<std::string> items;
    std::size_t line = 0;
    bool used = false;
  };
  using Table = std::map<std::string, Value>;

  explicit RigFile(const std::filesystem::path& path);

  /// Names of the tables [prefix.NAME], in the order of the file.
  std::vector<std::string> tables_in(const std::string& prefix) const;
  /// Keys of [table], in alphabetic order.
  std::vector<std::string> keys_of(const std::string& table) const;
  bool has(const std::string& table, const std::string& key) const;
  /// Line of a key, or of its table's header when the key is not there, or 0.
  std::size_t line_of(const std::string& table, const std::string& key = "") const;

  // A value of the asked kind; a missing key is an error.
  std::vector<std::string> texts(const std::string& table, const std::string& key);
  std::string text(const std::string& table, const std::string& key);
  double number(const std::string& table, const std::string& key);
  Vec3 point(const std::string& table, const std::string& key);
  /// A point that is not zero, scaled to length 1.
  Vec3 direction(const std::string& table, const std::string& key);

  /// Throws for the first key or table that was not asked for.
  void refuse_the_rest() const;
  [[noreturn]] void fail(const std::string& table, const std::string& key, const std::string& what) const;

 private:
  void find_lines();

  TextFile file_;
  std::map<std::string, Table> tables_;
  std::vector<std::string> order_;
  std::map<std::string, std::size_t> lines_;  // of "table" and "table.key"
};

}  // namespace skinbem
