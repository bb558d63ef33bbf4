// SPDX-License-Identifier: BSD-3-Clause
#include <map>
#include <nlohmann/json.hpp>

#include <skinbem/io/npy.hpp>

#include "program.hpp"
#include "tolerances.hpp"

namespace skinbem::cli_testing {
namespace {

using testing::HasSubstr;
using testing_support::shared_data;

class Response : public Program {
 protected:
  Arguments box_to(const std::string& output) { return Arguments{"response"} + box() + Arguments{"-o", path(output)}; }
  /// Largest difference of R, written by the program, from a reference file, relative to its largest entry.
  double error(const std::string& mesh, const std::string& landmarks, const std::string& poisson,
               const std::string& reference) {
    const Outcome outcome = run({"response", mesh, "--landmarks", landmarks, "--poisson", poisson, "--tolerance",
                                 "1e-10", "-o", path("R.npy")});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    if (outcome.code != 0) return 1;
    const Eigen::MatrixXd made = read_npy(path("R.npy")), expected = read_npy(reference);
    EXPECT_EQ(made.rows(), expected.rows());
    EXPECT_EQ(made.cols(), expected.cols());
    return (made - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
  }
  Outcome with_landmarks(const std::string& csv) {
    return run({"response", shipped("tests/reference/box.obj"), "--landmarks", file("landmarks.csv", csv), "-o",
                path("R.npy")});
  }
};

std::vector<std::string> keys(const nlohmann::ordered_json& object) {
  std::vector<std::string> names;
  for (const auto& [key, value] : object.items()) names.push_back(key);
  return names;
}

TEST_F(Response, IsTheProjectsReference) {
  for (const std::string body : {"box", "ellipsoid"}) {
    for (const auto& [poisson, name] : {std::pair{"0.3", "030"}, {"0.45", "045"}}) {
      const std::string stem = shipped("tests/reference/" + body);
      EXPECT_LT(error(stem + ".obj", stem + "_landmarks.csv", poisson, stem + "_R_nu" + name + ".npy"),
                tolerance::program_response)
          << body << ' ' << poisson;
    }
  }
}

TEST_F(Response, HasDisplacementsOfTheKindAskedFor) {
  std::map<std::string, Eigen::MatrixXd> responses;
  for (const std::string kind : {"", "linear", "curved"}) {
    Arguments arguments = box_to("R.npy");
    if (!kind.empty()) arguments.insert(arguments.end(), {"--displacements", kind});
    const Outcome outcome = run(arguments);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    responses[kind] = read_npy(path("R.npy"));
  }
  EXPECT_EQ(responses["linear"], responses[""]);
  EXPECT_GT((responses["curved"] - responses[""]).cwiseAbs().maxCoeff(), 1e-3);
  const Outcome smooth = run(box_to("R.npy") + Arguments{"--radius", "0.2", "--loads", "smooth"});
  ASSERT_EQ(smooth.code, 0) << smooth.err;
  EXPECT_GT((read_npy(path("R.npy")) - responses[""]).cwiseAbs().maxCoeff(), 1e-3);
  const Outcome refused = run(box_to("R.npy") + Arguments{"--displacements", "cubic"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("choose one of: curved, linear"));
}

TEST_F(Response, IsTheReferenceOfTheSphere) {
  SKINBEM_NEEDS_SHARED_DATA("reference/icosphere162.obj");
  for (const auto& [poisson, name] : {std::pair{"0.3", "030"}, {"0.45", "045"}}) {
    const std::string stem = shared_data("reference/icosphere162").string();
    EXPECT_LT(error(stem + ".obj", stem + "_landmarks.csv", poisson, stem + "_R_nu" + name + ".npy"),
              tolerance::program_response)
        << poisson;
  }
}

TEST_F(Response, FileIsFloat64InCOrderOfVerticesAndLandmarks) {
  ASSERT_EQ(run(box_to("R.npy")).code, 0);
  const std::string bytes = read_file(path("R.npy"));
  EXPECT_THAT(bytes, HasSubstr("'descr': '<f8', 'fortran_order': False, 'shape': (54, 9)"));
  // A point landmark's own rows are the identity; box_landmarks.csv has its landmarks on these vertices.
  const Eigen::MatrixXd response = read_npy(path("R.npy"));
  const int vertices[] = {0, 5, 16};
  for (int k = 0; k < 3; ++k) {
    const auto own = response.block<3, 9>(3 * vertices[k], 0);
    Eigen::Matrix<double, 3, 9> expected = Eigen::Matrix<double, 3, 9>::Zero();
    expected.block<3, 3>(0, 3 * k).setIdentity();
    EXPECT_LT((own - expected).cwiseAbs().maxCoeff(), tolerance::program_response);
  }
}

TEST_F(Response, Float32IsTheSameRounded) {
  ASSERT_EQ(run(box_to("R.npy")).code, 0);
  ASSERT_EQ(run(box_to("F.npy") + Arguments{"--float32"}).code, 0);
  EXPECT_THAT(read_file(path("F.npy")), HasSubstr("'descr': '<f4'"));
  EXPECT_EQ(read_npy(path("F.npy")), read_npy(path("R.npy")).cast<float>().cast<double>());
}

TEST_F(Response, JsonIsOneObjectWithTheKeysOfTheContract) {
  for (const char* solver : {"auto", "dense", "hmatrix"}) {
    const Outcome outcome = run(box_to("R.npy") + Arguments{"--json", "--solver", solver, "--threads", "1"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(lines(outcome.out), 1);
    const auto report = nlohmann::ordered_json::parse(outcome.out);
    EXPECT_THAT(keys(report), testing::ElementsAre("version", "mesh", "landmarks", "poisson", "solver", "tolerance",
                                                   "estimated_error", "residual", "iterations", "threads", "seconds",
                                                   "peak_bytes", "predicted"));
    EXPECT_THAT(keys(report["mesh"]), testing::ElementsAre("vertices", "triangles", "volume"));
    EXPECT_THAT(keys(report["seconds"]), testing::ElementsAre("read", "assemble", "factor", "solve", "total"));
    EXPECT_EQ(report["mesh"]["vertices"], 18);
    EXPECT_EQ(report["mesh"]["triangles"], 32);
    EXPECT_EQ(report["landmarks"], 3);
    EXPECT_EQ(report["poisson"], 0.45);
    EXPECT_THAT(keys(report["predicted"]), testing::ElementsAre("seconds", "bytes"));
    EXPECT_EQ(report["solver"], std::string(solver) == "hmatrix" ? "hmatrix" : "dense");
    EXPECT_EQ(report["tolerance"], 1e-6);
    EXPECT_EQ(report["threads"], 1);
    EXPECT_LE(report["estimated_error"], 2e-6);
  }
}

TEST_F(Response, OfATetrahedronIsTheAffineMap) {
  const std::string mesh = file("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  const Outcome outcome =
      run({"response", mesh, "--landmarks", file("l.csv", "name,vertex\na,0\nb,1\nc,2\nd,3\n"), "-o", path("R.npy")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_LT((read_npy(path("R.npy")) - Eigen::MatrixXd::Identity(12, 12)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST_F(Response, LandmarksThatCannotHoldABodyAreNamed) {
  expect_failure(with_landmarks(""), 3, "landmarks.csv: is empty");
  expect_failure(with_landmarks("name,vertex\n"), 3, "landmarks.csv: holds no landmark");
  expect_failure(with_landmarks("name,vertex\na,0\nb,1\n"), 3, "landmarks.csv: 2 landmarks: at least three");
  expect_failure(with_landmarks("name,vertex\na,0\nb,1\nc,1\n"), 3, "landmarks b and c are both on vertex 1");
  expect_failure(with_landmarks("name,vertex\na,0\na,1\nc,2\n"), 3, "landmarks.csv:3: landmark 'a' is given twice");
  expect_failure(with_landmarks("name,vertex\na,0\nb,1\nc,18\n"), 3, "landmarks.csv:4: vertex 18 is not on the mesh");
  expect_failure(with_landmarks("name,vertx\na,0\n"), 3, "landmarks.csv:1: unknown column 'vertx'");
  expect_failure(with_landmarks("name,x,y,z\na,nan,0,0\nb,1,0,0\nc,0,1,0\n"), 3, "landmarks.csv:2: 'nan'");
  expect_failure(with_landmarks("name,vertex\na,1.5\nb,1\nc,2\n"), 3, "landmarks.csv:2: ");
  expect_failure(with_landmarks("name,x,y,z\na,99,0,0\nb,1,0,0\nc,0,1,0\n"), 3, "landmarks.csv:2: ");
  EXPECT_THAT(written(), testing::ElementsAre("landmarks.csv"));
}

TEST_F(Response, RadiusInAnotherUnitIsRefused) {
  expect_failure(run(box_to("R.npy") + Arguments{"--radius", "15000"}), 3,
                 "box_landmarks.csv: the landmarks cannot be told apart");
  EXPECT_TRUE(written().empty());
}

TEST_F(Response, LandmarksOnALineAreRefused) {
  // Three vertices of an edge of a 2 by 1 by 1 box of which the long edges are halved.
  const std::string mesh =
      file("b.obj",
           "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 0 0 1\nv 2 0 1\nv 2 1 1\nv 0 1 1\nv 1 0 0\n"
           "f 1 4 9\nf 4 3 9\nf 3 2 9\nf 5 6 7 8\nf 1 9 5\nf 9 6 5\nf 9 2 6\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  expect_failure(
      run({"response", mesh, "--landmarks", file("l.csv", "name,vertex\na,0\nb,1\nc,8\n"), "-o", path("R.npy")}), 3,
      "l.csv: ");
  EXPECT_FALSE(fs::exists(path("R.npy")));
}

}  // namespace
}  // namespace skinbem::cli_testing
