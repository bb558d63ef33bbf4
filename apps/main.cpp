// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>

#include <skinbem/base/error.hpp>

#include "commands.hpp"
#include "console.hpp"

namespace {

std::string usage_message(const CLI::App* program, const CLI::Error& error) {
  const std::vector<std::string> rest = program->remaining();
  const std::vector<CLI::App*> commands = program->get_subcommands();
  std::string what = error.what(), command;
  if (!commands.empty()) {
    command = commands.front()->get_name() + " ";
  } else if (!rest.empty()) {
    what =
        "'" + rest.front() + "' is no command or option here, the commands are demo, check, response, animate and info";
  }
  std::replace(what.begin(), what.end(), '\n', ' ');
  return "skinbem: " + what + " (`skinbem " + command + "--help` tells more)\n";
}

/// Exit codes are those of skinbem::ErrorCode: 2 usage, 3 bad input, 4 numerical failure, 5 files.
int run(int argc, char** argv) {
  CLI::App program("Skin deformation from a few landmarks, with the boundary element method", "skinbem");
  program.set_version_flag("--version", "skinbem " SKINBEM_VERSION);
  program.require_subcommand(1);
  program.get_formatter()->column_width(34);
  program.failure_message(usage_message);
  program.footer(
      "Exit codes: 0 ok, 2 usage, 3 bad input, 4 numerical failure, 5 a file cannot be read or written.\n"
      "Results go to stdout, messages and progress to stderr. `skinbem COMMAND --help` tells more.");
  add_demo(program);
  add_check(program);
  add_response(program);
  add_animate(program);
  add_info(program);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? 0 : static_cast<int>(skinbem::ErrorCode::usage);
  }
  return 0;
}

/// What was printed may still lie in a buffer: a full disk is noticed here or nowhere.
void flush_results() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  throw skinbem::Error(skinbem::ErrorCode::io, "standard output: cannot write the results, check where they go");
}

int fail(const std::string& message, int code) {
  end_progress();
  fmt::print(stderr, "skinbem: {}\n", message);
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const int code = run(argc, argv);
    end_progress();
    flush_results();
    return code;
  } catch (const skinbem::Error& error) {
    return fail(error.what(), static_cast<int>(error.code()));
  } catch (const std::bad_alloc&) {
    return fail("out of memory, use a coarser mesh", static_cast<int>(skinbem::ErrorCode::numerical));
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(error.path1().string() + ": " + error.code().message() + ", check the path and its permissions",
                static_cast<int>(skinbem::ErrorCode::io));
  } catch (const std::exception& error) {
    return fail(error.what(), static_cast<int>(skinbem::ErrorCode::io));
  }
}
