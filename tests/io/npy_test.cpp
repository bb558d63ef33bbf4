// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/io/npy.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <skinbem/base/atomic_file.hpp>
#include <skinbem/base/error.hpp>

#include "files.hpp"

namespace skinbem {
namespace {

using testing::HasSubstr;
using testing_support::TemporaryFolder;

/// An NPY file of format 1.0 with this dictionary and these bytes.
std::string npy(const std::string& dictionary, const std::string& bytes, char major = 1) {
  const std::size_t length = dictionary.size();
  std::string file("\x93NUMPY", 6);
  file += major;
  file += '\0';
  file += static_cast<char>(length & 255);
  file += static_cast<char>(length >> 8);
  if (major == 2) file += std::string(2, '\0');
  return file + dictionary + bytes;
}

template <class T>
std::string bytes_of(std::vector<T> values, bool swapped = false) {
  std::string bytes(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  if (swapped) {
    for (std::size_t i = 0; i < bytes.size(); i += sizeof(T)) std::reverse(&bytes[i], &bytes[i] + sizeof(T));
  }
  return bytes;
}

class Npy : public testing::Test {
 protected:
  Eigen::MatrixXd read(const std::string& content) {
    write_file_atomically(folder_ / "a.npy", [&](std::ostream& out) { out << content; });
    return read_npy(folder_ / "a.npy");
  }
  void expect_refused(const std::string& content, const std::string& why) {
    try {
      read(content);
      FAIL() << "was accepted: " << why;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_input);
      EXPECT_THAT(error.what(), HasSubstr(why));
    }
  }
  TemporaryFolder folder_;
  const Eigen::MatrixXd small_ = (Eigen::MatrixXd(2, 3) << 1, 2, 3, 4, 5, 6).finished();
};

TEST_F(Npy, Float64ComesBackBitForBit) {
  const Eigen::MatrixXd matrix = Eigen::MatrixXd::Random(30, 18) * 1e-7;
  write_npy(folder_ / "r.npy", matrix);
  EXPECT_EQ(read_npy(folder_ / "r.npy"), matrix);
}

TEST_F(Npy, Float32ComesBackRoundedToFloat) {
  const Eigen::MatrixXd matrix = Eigen::MatrixXd::Random(7, 5);
  write_npy(folder_ / "r.npy", matrix, NpyType::float32);
  EXPECT_EQ(read_npy(folder_ / "r.npy"), matrix.cast<float>().cast<double>());
}

TEST_F(Npy, EntriesStartAtAMultipleOf64BytesInCOrder) {
  write_npy(folder_ / "r.npy", small_);
  const std::string file = read_file(folder_ / "r.npy");
  ASSERT_EQ(file.size() % 64, 48u);
  EXPECT_EQ(file.substr(file.size() - 48), bytes_of<double>({1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(file[file.size() - 49], '\n');
  EXPECT_THAT(file, HasSubstr("{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }"));
}

TEST_F(Npy, ReadsFortranOrderBigEndianAndFormat2) {
  const std::string tail = "'shape': (2, 3), }\n";
  EXPECT_EQ(read(npy("{'descr': '<f8', 'fortran_order': True, " + tail, bytes_of<double>({1, 4, 2, 5, 3, 6}))), small_);
  EXPECT_EQ(read(npy("{'descr': '>f8', 'fortran_order': False, " + tail, bytes_of<double>({1, 2, 3, 4, 5, 6}, true))),
            small_);
  EXPECT_EQ(read(npy("{'descr': '>f4', 'fortran_order': False, " + tail, bytes_of<float>({1, 2, 3, 4, 5, 6}, true))),
            small_);
  EXPECT_EQ(read(npy("{'descr': '<f4', 'fortran_order': False, " + tail, bytes_of<float>({1, 2, 3, 4, 5, 6}), 2)),
            small_);
}

TEST_F(Npy, RefusesWhatIsNoMatrixOfFiniteNumbers) {
  const std::string six = bytes_of<double>({1, 2, 3, 4, 5, 6}), head = "{'descr': '<f8', 'fortran_order': False, ";
  const std::string good = head + "'shape': (2, 3), }\n";
  expect_refused("", "not an NPY file");
  expect_refused("PK\x03\x04", "not an NPY file");
  expect_refused(npy(good, six).substr(0, 40), "truncated");
  expect_refused(npy(good, six.substr(0, 40)), "damaged");
  expect_refused(npy(good, six + "x"), "damaged");
  expect_refused(npy(good, six, 3), "format 3");
  expect_refused(npy(head + "'shape': (6,), }\n", six), "1 dimensions");
  expect_refused(npy(head + "'shape': (4294967296, 4294967296), }\n", ""), "damaged");
  expect_refused(npy(head + "'shape': (-2, 3), }\n", six), "a number was expected");
  expect_refused(npy("{'descr': '<i8', 'fortran_order': False, 'shape': (2, 3), }\n", six), "<i8");
  expect_refused(npy("{'descr': '|O', 'fortran_order': False, 'shape': (2, 3), }\n", six), "|O");
  expect_refused(npy(head + "}\n", six), "lacks");
  expect_refused(npy(head + "'shape': (2, 3), 'more': 1}\n", six), "'more'");
  expect_refused(npy(good + "}", six), "after the header");
  expect_refused(npy(good, bytes_of<double>({1, 2, 3, 4, std::nan(""), 6})), "entry (1, 1) is not finite");
}

TEST_F(Npy, NeverWritesWhatIsNotFinite) {
  for (double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Eigen::MatrixXd matrix = small_;
    matrix(1, 2) = bad;
    EXPECT_THROW(write_npy(folder_ / "r.npy", matrix), Error);
  }
  EXPECT_THROW(write_npy(folder_ / "r.npy", small_ * 1e300, NpyType::float32), Error);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "r.npy"));
}

}  // namespace
}  // namespace skinbem
