// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/base/atomic_file.hpp>

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>

#include <skinbem/base/error.hpp>

namespace skinbem {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* action) {
  const int reason = errno;
  throw Error(ErrorCode::io, path.string() + ": cannot " + action + ": " +
                                 (reason ? std::strerror(reason) : "the stream failed") +
                                 ", check the path and its permissions");
}

/// Removes the temporary unless it was renamed away.
class Temporary {
 public:
  explicit Temporary(std::filesystem::path path) : path_(std::move(path)) {}
  ~Temporary() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove(path_, ignored);
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  const std::filesystem::path& path() const { return path_; }
  void release() { path_.clear(); }

 private:
  std::filesystem::path path_;
};

}  // namespace

void write_file_atomically(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write) {
  if (std::filesystem::is_directory(path)) {
    throw Error(ErrorCode::io, path.string() + ": is a directory, name a file");
  }
  if (std::filesystem::exists(path) && !std::filesystem::is_regular_file(path)) {
    throw Error(ErrorCode::io, path.string() + ": is no ordinary file, it would be replaced by one: name another");
  }
  Temporary temporary(path.string() + ".tmp" + std::to_string(::getpid()));
  {
    errno = 0;
    std::ofstream out(temporary.path(), std::ios::binary | std::ios::trunc);
    if (!out) fail(path, "write");
    write(out);
    out.flush();
    if (!out) fail(path, "write");
  }
  std::error_code error;
  std::filesystem::rename(temporary.path(), path, error);
  if (error) throw Error(ErrorCode::io, path.string() + ": cannot write: " + error.message());
  temporary.release();
}

std::string read_file(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) {
    throw Error(ErrorCode::io, path.string() + ": is a directory, name a file");
  }
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) fail(path, "read");
  std::ostringstream content;
  content << in.rdbuf();
  if (in.bad()) fail(path, "read");
  return std::move(content).str();
}

}  // namespace skinbem
