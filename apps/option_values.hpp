// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What an option takes, with messages that say it.
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <map>
#include <string>

/// One of a few words, turned into the value that it stands for.
template <class T>
CLI::Validator word(const std::map<std::string, T>& values) {
  return CLI::Validator(
      [values](std::string& text) -> std::string {
        const auto found = values.find(text);
        if (found != values.end()) {
          if constexpr (std::is_enum_v<T>) text = std::to_string(static_cast<int>(found->second));
          return {};
        }
        std::string known;
        for (const auto& entry : values) known += (known.empty() ? "" : ", ") + entry.first;
        return "'" + text + "' is not known, choose one of: " + known;
      },
      "", "word");
}

/// A number for which `holds`; `what` says which numbers those are.
template <class Predicate>
CLI::Validator number(Predicate holds, const std::string& what) {
  return CLI::Validator(
      [holds, what](std::string& text) -> std::string {
        double value = 0;
        const bool read = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
        return read && holds(value) ? "" : "'" + text + "' is not " + what;
      },
      "", "number");
}

/// Any number: without a check, nothing at all would be taken for 0.
inline CLI::Validator number() {
  return number([](double) { return true; }, "a finite number");
}
