// SPDX-License-Identifier: BSD-3-Clause
#include "program.hpp"

namespace skinbem::cli_testing {
namespace {

using testing::HasSubstr;

class Usage : public Program {};

TEST_F(Usage, HelpAndVersionSucceedAndGoToStdout) {
  for (const Arguments& arguments : {Arguments{"--help"},
                                     {"--version"},
                                     {"demo", "--help"},
                                     {"check", "--help"},
                                     {"response", "--help"},
                                     {"animate", "--help"},
                                     {"info", "--help"}}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << arguments.front();
    EXPECT_EQ(outcome.err, "");
    EXPECT_NE(outcome.out, "");
  }
  for (const char* command : {"demo", "check", "response", "animate", "info"}) {
    EXPECT_THAT(run({"--help"}).out, HasSubstr(command));
  }
}

TEST_F(Usage, InfoNamesVersionInstructionsBlasAndThreads) {
  const Outcome outcome = run({"info"});
  EXPECT_EQ(outcome.code, 0);
  for (const char* what : {"skinbem", "instruction set", "BLAS", "threads"}) EXPECT_THAT(outcome.out, HasSubstr(what));
}

TEST_F(Usage, WrongCommandsAndOptionsAreNamedWithCode2) {
  expect_failure(run({}), 2, "subcommand");
  expect_failure(run({"bogus"}), 2, "'bogus'");
  expect_failure(run({"--bogus"}), 2, "'--bogus'");
  expect_failure(run({"check"}), 2, "MESH");
  expect_failure(run({"info", "more"}), 2, "more");
  expect_failure(run(Arguments{"response"} + box()), 2, "--output");
  expect_failure(run({"response", shipped("tests/reference/box.obj"), "-o", path("R.npy")}), 2, "--landmarks");
  expect_failure(run(Arguments{"response"} + box() + Arguments{"-o", path("R.npy"), "--bogus"}), 2, "--bogus");
}

TEST_F(Usage, ValuesOutOfRangeAreNamedWithCode2AndWriteNothing) {
  const std::vector<std::pair<const char*, const char*>> wrong{
      {"--poisson", "0.7"},    {"--poisson", "-1"},    {"--poisson", "nan"}, {"--poisson", "abc"},
      {"--poisson", ""},       {"--tolerance", "0"},   {"--tolerance", "1"}, {"--tolerance", "nan"},
      {"--radius", "-1"},      {"--radius", "inf"},    {"--threads", "-1"},  {"--threads", "1.5"},
      {"--threads", "100000"}, {"--solver", "direct"}, {"--memory", "-1"},   {"--memory", "1e-6"},
  };
  for (const auto& [option, value] : wrong) {
    const Outcome outcome = run(Arguments{"response"} + box() + Arguments{"-o", path("R.npy"), option, value});
    EXPECT_EQ(outcome.code, 2) << option << ' ' << value << '\n' << outcome.err;
    EXPECT_EQ(lines(outcome.err), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
  EXPECT_TRUE(written().empty());
  expect_failure(run(Arguments{"response"} + box() + Arguments{"-o", path("R.npy"), "--solver", "direct"}), 2,
                 "--solver: 'direct' is not known, choose one of: auto, dense, hmatrix");
  expect_failure(run(Arguments{"response"} + box() + Arguments{"-o", path("R.npy"), "--memory", "0.001"}), 2,
                 "not enough memory for 18 vertices");
}

TEST_F(Usage, ValuesOfAnimateOutOfRangeAreNamedWithCode2) {
  const Arguments animate = Arguments{"animate"} + box() + Arguments{"--motion", shipped("data/lower_limb/walk.bvh"),
                                                                     "--rig",    shipped("data/lower_limb/rig.toml"),
                                                                     "-o",       path("a.glb")};
  const std::vector<std::pair<const char*, const char*>> wrong{
      {"--mode", "foo"}, {"--frame", "foo"}, {"--artefact", "foo"}, {"--fps", "0"},         {"--seed", "-1"},
      {"--seed", "1.5"}, {"--from", ""},     {"--to", "nan"},       {"--artefact-mean", ""}};
  for (const auto& [option, value] : wrong) expect_failure(run(animate + Arguments{option, value}), 2, option);
  expect_failure(run(animate + Arguments{"--from", "a"}), 2, "--from");
  expect_failure(run(animate + Arguments{"--fps", "1e9"}), 2, "more than 1000000 frames");
  EXPECT_TRUE(written().empty());
}

}  // namespace
}  // namespace skinbem::cli_testing
