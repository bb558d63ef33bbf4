// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Runs the `skinbem` program as a user does: another process, its exit code, what it printed, what it wrote.
#pragma once

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <string>
#include <vector>

#include <skinbem/base/atomic_file.hpp>

#include "files.hpp"

extern char** environ;

namespace skinbem::cli_testing {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

struct Outcome {
  int code = -1;  ///< exit code; 128 and the signal where one ended it
  std::string out, err;
};

inline Arguments operator+(Arguments a, const Arguments& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// A folder to write into, and the program.
class Program : public testing::Test {
 protected:
  Outcome run(const Arguments& arguments) { return run_into(logs_ / "out", arguments); }

  /// The same with standard output in another file.
  Outcome run_into(const std::string& out, const Arguments& arguments) {
    std::vector<std::string> words = Arguments{SKINBEM_PROGRAM} + arguments;
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const std::string err = logs_ / "err";
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    pid_t process = 0;
    const int failed = posix_spawn(&process, SKINBEM_PROGRAM, &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    EXPECT_EQ(failed, 0) << "cannot start " << SKINBEM_PROGRAM;
    if (failed != 0) return {};
    int status = 0;
    waitpid(process, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
            fs::is_regular_file(out) ? read_file(out) : "", read_file(err)};
  }

  /// Writes a file into the folder and returns its path.
  std::string file(const std::string& name, const std::string& text) {
    write_file_atomically(folder_ / name, [&](std::ostream& out) { out << text; });
    return path(name);
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// Names of all that is in the folder, sorted.
  std::vector<std::string> written() const {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_.path())) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  testing_support::TemporaryFolder folder_;

 private:
  testing_support::TemporaryFolder logs_;
};

inline std::string shipped(const std::string& name) { return testing_support::project_file(name).string(); }

/// The small body of tests/reference, with its landmarks.
inline Arguments box() {
  return {shipped("tests/reference/box.obj"), "--landmarks", shipped("tests/reference/box_landmarks.csv")};
}

inline auto lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

/// Failed with this code, printed no result, and said why in one line that holds `why`.
inline void expect_failure(const Outcome& outcome, int code, const std::string& why) {
  EXPECT_EQ(outcome.code, code) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(lines(outcome.err), 1) << outcome.err;
  EXPECT_THAT(outcome.err, testing::StartsWith("skinbem: "));
  EXPECT_THAT(outcome.err, testing::HasSubstr(why));
}

}  // namespace skinbem::cli_testing
