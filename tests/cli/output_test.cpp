// SPDX-License-Identifier: BSD-3-Clause
#include <sys/stat.h>
#include <unistd.h>

#include "program.hpp"

namespace skinbem::cli_testing {
namespace {

class Output : public Program {
 protected:
  Outcome response_to(const std::string& output) {
    return run(Arguments{"response"} + box() + Arguments{"-o", output});
  }
};

TEST_F(Output, InAMissingFolderIsCode5) {
  expect_failure(response_to(path("none/R.npy")), 5, "there is no folder");
  EXPECT_TRUE(written().empty());
}

TEST_F(Output, ThatIsADirectoryOrADeviceIsCode5) {
  expect_failure(response_to(folder_.path().string()), 5, "is a directory");
  expect_failure(response_to(folder_.path().string() + "/"), 5, "is a directory");
  const std::string pipe = path("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  expect_failure(response_to(pipe), 5, "is no ordinary file");
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(Output, InAFolderWithoutPermissionIsCode5) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  fs::create_directory(path("locked"));
  fs::permissions(path("locked"), fs::perms::owner_read | fs::perms::owner_exec);
  expect_failure(response_to(path("locked/R.npy")), 5, "no permission");
  fs::permissions(path("locked"), fs::perms::owner_all);
}

TEST_F(Output, WithoutANameIsCode2) {
  expect_failure(response_to(""), 2, "no name");
  expect_failure(run({"demo", "-o", ""}), 2, "no name");
}

TEST_F(Output, WithANameTooLongIsCode5) {
  const std::string name = path(std::string(300, 'x') + ".obj"), why = name + ": File name too long, check the path";
  expect_failure(response_to(name), 5, why);
  expect_failure(run({"check", name}), 5, why);
}

TEST_F(Output, OfResultsThatCannotBePrintedIsCode5) {
  for (const Arguments& arguments : {Arguments{"info"}, {"--help"}, {"check", shipped("tests/reference/box.obj")}}) {
    expect_failure(run_into("/dev/full", arguments), 5, "standard output: cannot write");
  }
}

TEST_F(Output, NeverReplacesAnInput) {
  const std::string mesh = file("b.obj", read_file(shipped("tests/reference/box.obj")));
  const std::string landmarks = file("b.csv", read_file(shipped("tests/reference/box_landmarks.csv")));
  const std::string before = read_file(mesh);
  expect_failure(run({"response", mesh, "--landmarks", landmarks, "-o", path("./b.obj")}), 2, "is the input");
  expect_failure(run({"response", mesh, "--landmarks", landmarks, "-o", landmarks}), 2, "is the input");
  EXPECT_EQ(read_file(mesh), before);
}

TEST_F(Output, OfBeforeSurvivesAFailureAndNoTemporaryIsLeft) {
  const std::string output = file("R.npy", "of before");
  const std::string landmarks = file("two.csv", "name,vertex\na,0\nb,1\n");
  EXPECT_EQ(run({"response", shipped("tests/reference/box.obj"), "--landmarks", landmarks, "-o", output}).code, 3);
  EXPECT_EQ(read_file(output), "of before");
  EXPECT_THAT(written(), testing::ElementsAre("R.npy", "two.csv"));
}

TEST_F(Output, OfBeforeIsReplacedBySuccessAndNoTemporaryIsLeft) {
  const std::string output = file("R.npy", "of before");
  EXPECT_EQ(response_to(output).code, 0);
  EXPECT_NE(read_file(output), "of before");
  EXPECT_THAT(written(), testing::ElementsAre("R.npy"));
}

}  // namespace
}  // namespace skinbem::cli_testing
