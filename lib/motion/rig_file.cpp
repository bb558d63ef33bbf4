// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/motion/rig_file.hpp>

#include <CLI/CLI.hpp>
#include <sstream>

namespace skinbem {

RigFile::RigFile(const std::filesystem::path& path) : file_(path) {
  find_lines();
  std::istringstream stream(file_.text());
  for (const CLI::ConfigItem& item : CLI::ConfigTOML().from_config(stream)) {
    if (item.name == "++" || item.name == "--") continue;  // the reader's marks for a table's begin and end
    const std::string table = CLI::detail::join(item.parents, ".");
    tables_[table][item.name] = {item.inputs, line_of(table, item.name)};
  }
}

/// The reader keeps no lines, so headers and keys are looked for once more.
void RigFile::find_lines() {
  std::string table;
  for (std::size_t i = 0; i < file_.lines().size(); ++i) {
    std::string_view line = trimmed(file_.lines()[i].substr(0, file_.lines()[i].find('#')));
    const std::size_t equals = line.find('=');
    if (line.starts_with('[') && line.ends_with(']') && equals == std::string_view::npos) {
      table = trimmed(line.substr(1, line.size() - 2));
      if (!lines_.emplace(table, i + 1).second) file_.fail(i + 1, "table [" + table + "] is given twice, join the two");
      order_.push_back(table);
      tables_[table];
    } else if (equals != std::string_view::npos) {
      std::string key(trimmed(line.substr(0, equals)));
      CLI::detail::remove_quotes(key);
      if (!lines_.emplace(table + "." + key, i + 1).second) file_.fail(i + 1, "'" + key + "' is given twice, keep one");
    }
  }
}

std::vector<std::string> RigFile::tables_in(const std::string& prefix) const {
  std::vector<std::string> result;
  for (const std::string& table : order_) {
    if (table.starts_with(prefix + ".")) result.push_back(table.substr(prefix.size() + 1));
  }
  return result;
}

std::vector<std::string> RigFile::keys_of(const std::string& table) const {
  std::vector<std::string> result;
  const auto found = tables_.find(table);
  if (found == tables_.end()) return result;
  for (const auto& [key, value] : found->second) result.push_back(key);
  return result;
}

bool RigFile::has(const std::string& table, const std::string& key) const {
  const auto found = tables_.find(table);
  return found != tables_.end() && found->second.contains(key);
}

std::size_t RigFile::line_of(const std::string& table, const std::string& key) const {
  auto found = lines_.find(table + "." + key);
  if (found == lines_.end()) found = lines_.find(table);
  return found == lines_.end() ? 0 : found->second;
}

std::vector<std::string> RigFile::texts(const std::string& table, const std::string& key) {
  if (!has(table, key)) fail(table, key, "[" + table + "] has no '" + key + "', add it");
  Value& value = tables_[table][key];
  value.used = true;
  for (const std::string& item : value.items) {
    if (item.empty()) fail(table, key, "'" + key + "' holds an empty value");
  }
  return value.items;
}

std::string RigFile::text(const std::string& table, const std::string& key) {
  const std::vector<std::string> items = texts(table, key);
  if (items.size() != 1) fail(table, key, "'" + key + "' must be a single value");
  return items[0];
}

double RigFile::number(const std::string& table, const std::string& key) {
  const std::string item = text(table, key);
  const std::optional<double> value = parse_number(item);
  if (!value) fail(table, key, "'" + key + "' must be a finite number, not '" + item + "'");
  return *value;
}

Vec3 RigFile::point(const std::string& table, const std::string& key) {
  const std::vector<std::string> items = texts(table, key);
  if (items.size() != 3) fail(table, key, "'" + key + "' must be three numbers, [x, y, z]");
  Vec3 point;
  for (int i = 0; i < 3; ++i) {
    const std::optional<double> value = parse_number(items[static_cast<std::size_t>(i)]);
    if (!value) fail(table, key, "'" + key + "' must be three finite numbers, [x, y, z]");
    point(i) = *value;
  }
  return point;
}

Vec3 RigFile::direction(const std::string& table, const std::string& key) {
  const Vec3 vector = point(table, key);
  if (!(vector.norm() > 0)) fail(table, key, "'" + key + "' must be a direction, not zero");
  return vector.normalized();
}

void RigFile::refuse_the_rest() const {
  for (const auto& [name, table] : tables_) {
    for (const auto& [key, value] : table) {
      if (!value.used) fail(name, key, "unknown key '" + key + "'" + (name.empty() ? "" : " in [" + name + "]"));
    }
  }
}

void RigFile::fail(const std::string& table, const std::string& key, const std::string& what) const {
  file_.fail(line_of(table, key), what);
}

}  // namespace skinbem
