// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/motion/trc.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "text_reader.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string walk =
    "PathFileType\t4\t(X/Y/Z)\twalk.trc\n"
    "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n"
    "50\t50\t3\t2\tcm\t50\t1\t3\n"
    "Frame#\tTime\tHeel\t\t\tToe\t\t\n"
    "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n"
    "\n"
    "7\t0.10\t1\t2\t3\t4\t5\t6\t\n"
    "8\t0.12\t1\t2\t3\t\t\t\n"
    "9\t0.14\tNaN\tNaN\tNaN\t7\t8\t9\n";

class TrcFile : public testing_support::TextReader<read_trc> {
 protected:
  TrcFile() : TextReader("walk.trc") {}
  std::string error_with(const std::string& from, const std::string& to) { return error_of(walk, from, to); }
};

TEST_F(TrcFile, GivesMillimetresAndKnowsWhatWasNotSeen) {
  const TrcMotion motion = read(walk);
  EXPECT_EQ(motion.markers, (std::vector<std::string>{"Heel", "Toe"}));
  EXPECT_EQ(motion.rate, 50);
  EXPECT_EQ(motion.first_time, 0.1);
  EXPECT_EQ(motion.first_frame, 7);
  EXPECT_EQ(motion.position(0, 0), Vec3(10, 20, 30));
  EXPECT_EQ(motion.position(1, 1), std::nullopt);
  EXPECT_EQ(motion.position(2, 0), std::nullopt);
  EXPECT_EQ(motion.position(2, 1), Vec3(70, 80, 90));
  EXPECT_EQ(motion.find("Toe"), 1);
  EXPECT_EQ(motion.find("Knee"), -1);
}

TEST_F(TrcFile, ReadsWindowsLineEnds) {
  std::string text;
  for (const char c : walk) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(read(text).frame_count(), 3);
}

TEST_F(TrcFile, NamesTheLineAndTheDefectOfAMalformedFile) {
  EXPECT_THAT(error_with("PathFileType", "Path"), AllOf(HasSubstr("walk.trc:1: "), HasSubstr("TRC")));
  EXPECT_THAT(error_with("Units", "Unit"), AllOf(HasSubstr("walk.trc:2: "), HasSubstr("'Units'")));
  EXPECT_THAT(error_with("\tcm\t", "\tinch\t"), AllOf(HasSubstr("walk.trc:3: "), HasSubstr("inch")));
  EXPECT_THAT(error_with("50\t50\t3", "0\t50\t3"), AllOf(HasSubstr("walk.trc:3: "), HasSubstr("positive")));
  EXPECT_THAT(error_with("50\t50\t3", "50\t50\t4"), HasSubstr("3 of 4"));
  EXPECT_THAT(error_with("50\t50\t3", "50\t50\t2"), AllOf(HasSubstr("walk.trc:9: "), HasSubstr("more frames")));
  EXPECT_THAT(error_with("3\t2\tcm", "3\t3\tcm"), AllOf(HasSubstr("walk.trc:4: "), HasSubstr("NumMarkers")));
  EXPECT_THAT(error_with("Heel", "Toe"), AllOf(HasSubstr("walk.trc:4: "), HasSubstr("two markers")));
  EXPECT_THAT(error_with("Heel\t\t\t", "Heel\t\t"), AllOf(HasSubstr("walk.trc:4: "), HasSubstr("field")));
  EXPECT_THAT(error_with("7\t0.10", "x\t0.10"), AllOf(HasSubstr("walk.trc:7: "), HasSubstr("whole number")));
  EXPECT_THAT(error_with("8\t0.12", "9\t0.12"), AllOf(HasSubstr("walk.trc:8: "), HasSubstr("up by one")));
  EXPECT_THAT(error_with("8\t0.12", "8\t0.22"), AllOf(HasSubstr("walk.trc:8: "), HasSubstr("time")));
  EXPECT_THAT(error_with("\t4\t5\t6\t", "\t4\t5\t6\t7"), AllOf(HasSubstr("walk.trc:7: "), HasSubstr("9 fields")));
  EXPECT_THAT(error_with("\t4\t5\t6\t", "\t4\t5"), AllOf(HasSubstr("walk.trc:7: "), HasSubstr("7 fields")));
  EXPECT_THAT(error_with("\t4\t5\t6\t", "\t4\t\t6\t"), AllOf(HasSubstr("walk.trc:7: "), HasSubstr("only some")));
  EXPECT_THAT(error_with("\t4\t5\t6\t", "\t4\tinf\t6\t"), AllOf(HasSubstr("walk.trc:7: "), HasSubstr("finite")));
}

}  // namespace
}  // namespace skinbem
