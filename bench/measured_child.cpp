// SPDX-License-Identifier: BSD-3-Clause
#include "measured_child.hpp"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <new>
#include <skinbem/base/error.hpp>

namespace skinbem::bench {
namespace {

constexpr double kGigabyte = 1e9;

std::string gigabytes(double bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f GB", bytes / kGigabyte);
  return text;
}

/// In the child: the result, or why there is none.
nlohmann::json attempt(const std::function<nlohmann::json()>& work, const ChildLimits& limits) try {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // an interrupted benchmark leaves nothing behind
  if (limits.bytes > 0) {
    const rlimit limit{static_cast<rlim_t>(limits.bytes), static_cast<rlim_t>(limits.bytes)};
    setrlimit(RLIMIT_AS, &limit);
  }
  if (limits.seconds > 0) alarm(static_cast<unsigned>(limits.seconds));
  return {{"result", work()}};
} catch (const std::bad_alloc&) {
  return {{"failure", "does not fit into " + gigabytes(limits.bytes)}};
} catch (const std::exception& error) {
  return {{"failure", error.what()}};
}

void write_all(int file, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = write(file, text.data() + done, text.size() - done);
    if (count <= 0) return;
    done += static_cast<std::size_t>(count);
  }
}

std::string read_all(int file) {
  std::string text;
  char buffer[4096];
  for (ssize_t count; (count = read(file, buffer, sizeof buffer)) > 0;) {
    text.append(buffer, static_cast<std::size_t>(count));
  }
  return text;
}

std::string cause_of_death(int status, const ChildLimits& limits) {
  if (!WIFSIGNALED(status)) return "ended with code " + std::to_string(WEXITSTATUS(status));
  if (WTERMSIG(status) == SIGALRM) return "not done after " + std::to_string(std::lround(limits.seconds)) + " s";
  if (WTERMSIG(status) == SIGKILL) return "killed, most likely for its memory";
  return "ended by signal " + std::to_string(WTERMSIG(status));
}

}  // namespace

ChildOutcome run_in_child(const std::function<nlohmann::json()>& work, const ChildLimits& limits) {
  int ends[2];
  if (pipe(ends) != 0) throw Error(ErrorCode::io, "no pipe to a child process");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw Error(ErrorCode::io, "no child process can be started");
  if (child == 0) {
    close(ends[0]);
    write_all(ends[1], attempt(work, limits).dump());
    _exit(0);
  }
  close(ends[1]);
  const std::string text = read_all(ends[0]);
  close(ends[0]);
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  ChildOutcome outcome;
  outcome.peak_bytes = 1024.0 * static_cast<double>(usage.ru_maxrss);
  const nlohmann::json answer = nlohmann::json::parse(text, nullptr, false);
  if (answer.is_discarded()) {
    outcome.failure = cause_of_death(status, limits);
  } else {
    outcome.failure = answer.value("failure", "");
    outcome.result = answer.value("result", nlohmann::json());
  }
  return outcome;
}

double available_bytes() {
  std::ifstream file("/proc/meminfo");
  std::string name, unit;
  for (double kilobytes = 0; file >> name >> kilobytes >> unit;) {
    if (name == "MemAvailable:") return 1024 * kilobytes;
  }
  throw Error(ErrorCode::io, "/proc/meminfo does not tell the available memory");
}

}  // namespace skinbem::bench
