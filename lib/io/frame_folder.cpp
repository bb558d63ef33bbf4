// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/io/frame_folder.hpp>

#include <unistd.h>

#include <algorithm>
#include <system_error>

#include <skinbem/base/error.hpp>

namespace skinbem {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t frame_digits = 6;

[[noreturn]] void fail(const fs::path& folder, const std::string& what) {
  throw Error(ErrorCode::io, folder.string() + ": " + what);
}

bool is_frame_file(const std::string& name, std::string_view extension) {
  std::string end(1, '.');
  end += extension;
  if (!name.ends_with(end) || name.size() < end.size() + frame_digits + 1) return false;
  const std::size_t digits = name.size() - end.size() - frame_digits;
  return name[digits - 1] == '_' &&
         std::all_of(name.begin() + static_cast<std::ptrdiff_t>(digits),
                     name.end() - static_cast<std::ptrdiff_t>(end.size()), [](char c) { return c >= '0' && c <= '9'; });
}

void require_replaceable(const fs::path& folder, std::string_view extension) {
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder)) fail(folder, "is a file, name a folder");
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (!entry.is_regular_file() || !is_frame_file(entry.path().filename().string(), extension)) {
      fail(folder, "holds " + entry.path().filename().string() + ", which is no frame; name a new or empty folder");
    }
  }
}

}  // namespace

std::string frame_file(std::string_view part, std::ptrdiff_t frame, std::string_view extension) {
  const std::string number = std::to_string(frame);
  const std::string zeros(frame_digits - std::min(number.size(), frame_digits), '0');
  return std::string(part) + '_' + zeros + number + '.' + std::string(extension);
}

void write_frame_folder(const fs::path& folder, std::string_view extension,
                        const std::function<void(const fs::path&)>& write) {
  // "out/" names the same folder as "out", whose name the temporaries extend.
  const fs::path place = folder.has_filename() ? folder : folder.parent_path();
  require_replaceable(place, extension);
  const std::string process = std::to_string(::getpid());
  const fs::path fresh = place.string() + ".tmp" + process, stale = place.string() + ".old" + process;
  try {
    fs::create_directory(fresh);
    write(fresh);
    const bool existed = fs::exists(place);
    if (existed) fs::rename(place, stale);
    std::error_code error;
    fs::rename(fresh, place, error);
    if (error) {
      if (existed) fs::rename(stale, place);
      throw fs::filesystem_error("rename", place, error);
    }
    fs::remove_all(stale);
  } catch (const fs::filesystem_error& error) {
    std::error_code ignored;
    fs::remove_all(fresh, ignored);
    fail(place, "cannot write: " + error.code().message());
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(fresh, ignored);
    throw;
  }
}

}  // namespace skinbem
