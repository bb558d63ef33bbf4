// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/base/atomic_file.hpp>

#include <gtest/gtest.h>

#include <filesystem>

#include <skinbem/base/error.hpp>

#include "files.hpp"

namespace skinbem {
namespace {

using testing_support::TemporaryFolder;

TEST(AtomicFile, WritesWhatWasStreamed) {
  TemporaryFolder folder;
  write_file_atomically(folder / "a.txt", [](std::ostream& out) { out << "first"; });
  write_file_atomically(folder / "a.txt", [](std::ostream& out) { out << "second"; });
  EXPECT_EQ(read_file(folder / "a.txt"), "second");
}

TEST(AtomicFile, KeepsTheOldFileAndLeavesNoTemporaryWhenTheWriterThrows) {
  TemporaryFolder folder;
  write_file_atomically(folder / "a.txt", [](std::ostream& out) { out << "old"; });
  EXPECT_THROW(write_file_atomically(folder / "a.txt",
                                     [](std::ostream& out) {
                                       out << "half";
                                       throw Error(ErrorCode::numerical, "stop");
                                     }),
               Error);
  EXPECT_EQ(read_file(folder / "a.txt"), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(AtomicFile, NamesThePathThatCannotBeWrittenOrRead) {
  TemporaryFolder folder;
  for (const auto& path : {folder / "no/such/folder.txt", folder.path()}) {
    try {
      write_file_atomically(path, [](std::ostream&) {});
      ADD_FAILURE() << path;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::io);
      EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos);
    }
    EXPECT_THROW(read_file(path), Error);
  }
}

}  // namespace
}  // namespace skinbem
