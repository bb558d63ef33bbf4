// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/io/vtk.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include <skinbem/base/atomic_file.hpp>

#include "files.hpp"
#include "small_animation.hpp"

namespace skinbem {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing_support::small_bones;
using testing_support::small_skin;
using testing_support::TemporaryFolder;

/// The bytes of the appended array called `name`.
std::string appended(const std::string& file, const std::string& name) {
  const std::size_t element = file.find("Name=\"" + name + "\""), begin = file.find("offset=\"", element) + 8;
  const std::size_t start = file.find("encoding=\"raw\">\n_") + 17 + std::stoul(file.substr(begin));
  std::uint64_t length;
  std::memcpy(&length, file.data() + start, 8);
  return file.substr(start + 8, length);
}

std::ptrdiff_t files_in(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

TEST(Vtk, AFrameHoldsTheSkinItsDisplacementAndItsTriangles) {
  TemporaryFolder folder;
  const SkinAnimation skin = small_skin(3);
  write_vtk_sequence(folder / "walk.pvd", skin, small_bones(3));
  const std::string file = read_file(folder / "walk_frames/skin_000002.vtp");
  EXPECT_THAT(file, HasSubstr("NumberOfPoints=\"6\""));
  const Eigen::Matrix<float, -1, 3, Eigen::RowMajor> expected = skin_vertices(skin, 2).cast<float>();
  const std::string points = appended(file, "points");
  ASSERT_EQ(points.size(), 6u * 12);
  EXPECT_EQ(std::memcmp(points.data(), expected.data(), points.size()), 0);
  const Eigen::Matrix<float, -1, 3, Eigen::RowMajor> moved =
      (skin_vertices(skin, 2) - skin.rest.vertices).cast<float>();
  EXPECT_EQ(std::memcmp(appended(file, "displacement").data(), moved.data(), points.size()), 0);
  const std::string corners = appended(file, "connectivity");
  ASSERT_EQ(corners.size(), 24u * 4);
  EXPECT_EQ(std::memcmp(corners.data(), skin.rest.triangles.data(), corners.size()), 0);
}

TEST(Vtk, TheCollectionNamesAnExistingFileForEachTimeAndPart) {
  TemporaryFolder folder;
  write_vtk_sequence(folder / "walk.pvd", small_skin(3), small_bones(3));
  const std::string pvd = read_file(folder / "walk.pvd");
  std::size_t count = 0;
  for (std::size_t at = 0; (at = pvd.find("file=\"", at)) != std::string::npos; ++count) {
    at += 6;
    EXPECT_TRUE(fs::exists(folder / pvd.substr(at, pvd.find('"', at) - at)));
  }
  EXPECT_EQ(count, 6u);
  EXPECT_THAT(pvd, HasSubstr("timestep=\"0.25\" part=\"0\""));
}

TEST(Vtk, AShorterSequenceReplacesALongerOneWhole) {
  TemporaryFolder folder;
  write_vtk_sequence(folder / "walk.pvd", small_skin(5), small_bones(5));
  write_vtk_sequence(folder / "walk.pvd", small_skin(2));
  EXPECT_EQ(files_in(folder / "walk_frames"), 2);
  EXPECT_EQ(files_in(folder.path()), 2);
}

TEST(FrameFolder, AFailureLeavesTheOldSequenceAndNothingElse) {
  TemporaryFolder folder;
  write_vtk_sequence(folder / "walk.pvd", small_skin(5));
  const auto cancel = [](std::string_view, double fraction) { return fraction < 0.5; };
  EXPECT_THROW(write_vtk_sequence(folder / "walk.pvd", small_skin(9), {}, cancel), Error);
  EXPECT_EQ(files_in(folder / "walk_frames"), 5);
  EXPECT_EQ(files_in(folder.path()), 2);
}

TEST(FrameFolder, NeverReplacesAFolderThatHoldsAnythingElse) {
  TemporaryFolder folder;
  fs::create_directory(folder / "walk_frames");
  write_file_atomically(folder / "walk_frames/thesis.vtp", [](std::ostream& out) { out << "precious"; });
  EXPECT_THROW(write_vtk_sequence(folder / "walk.pvd", small_skin(2)), Error);
  EXPECT_EQ(read_file(folder / "walk_frames/thesis.vtp"), "precious");
}

TEST(FrameFolder, AMissingParentIsAnErrorOfInputAndOutput) {
  TemporaryFolder folder;
  try {
    write_vtk_sequence(folder / "none/walk.pvd", small_skin(2));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::io);
  }
}

}  // namespace
}  // namespace skinbem
