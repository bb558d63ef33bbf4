// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/io/report.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include <skinbem/base/error.hpp>

namespace skinbem {
namespace {

RunReport example() {
  RunReport report;
  report.version = "0.1.0";
  report.vertices = 606;
  report.triangles = 1208;
  report.volume = 2.5e6;
  report.landmarks = 6;
  report.poisson = 0.45;
  report.solver = "dense";
  report.tolerance = 1e-6;
  report.residual = 1e-13;
  report.peak_bytes = 100'000'000;
  return report;
}

TEST(Report, JsonHasTheKeysOfTheContractInTheirOrder) {
  const auto object = nlohmann::ordered_json::parse(to_json(example()));
  std::vector<std::string> keys;
  for (const auto& item : object.items()) keys.push_back(item.key());
  EXPECT_THAT(keys,
              testing::ElementsAre("version", "mesh", "landmarks", "poisson", "solver", "tolerance", "estimated_error",
                                   "residual", "iterations", "threads", "seconds", "peak_bytes", "predicted"));
  EXPECT_EQ(object["mesh"].dump(), R"({"vertices":606,"triangles":1208,"volume":2500000.0})");
  EXPECT_EQ(object["seconds"].size(), 5u);
  EXPECT_TRUE(object["iterations"].is_null());
  EXPECT_EQ(object["residual"], 1e-13);
}

TEST(Report, NeverPrintsWhatIsNotFinite) {
  RunReport report = example();
  report.residual = std::nan("");
  EXPECT_THROW(to_json(report), Error);
  report = example();
  report.seconds.solve = INFINITY;
  EXPECT_THROW(to_json(report), Error);
}

TEST(Report, TextNamesWhatThereIs) {
  const std::string text = to_text(example());
  EXPECT_THAT(text, testing::HasSubstr("606 vertices"));
  EXPECT_THAT(text, testing::Not(testing::HasSubstr("iterations")));
}

}  // namespace
}  // namespace skinbem
