// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// From mesh and landmarks to R: what `response`, `animate` and `demo` share.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include <skinbem/io/report.hpp>
#include <skinbem/mesh/triangle_mesh.hpp>
#include <skinbem/response/response_model.hpp>

struct ResponseRunOptions {
  std::string mesh, landmarks;
  double poisson = 0.45, radius = 0, tolerance = 1e-6;
  skinbem::Displacements displacements = skinbem::Displacements::linear;
  skinbem::Loads loads = skinbem::Loads::linear;
  skinbem::Solver solver = skinbem::Solver::automatic;
  double memory_gigabytes = 0;
  int threads = 0;
  bool weld = false, force = false, json = false;
};

struct ResponseRun {
  skinbem::TriangleMesh mesh;
  std::vector<skinbem::Landmark> landmarks;
  skinbem::Points positions;  ///< of the landmarks at rest
  Eigen::MatrixXd response;
  skinbem::RunReport report;
};

void add_response_options(CLI::App& command, ResponseRunOptions& options);

/// Reads, validates and solves; R is read from `response_file` instead where one is given.
ResponseRun run_response(const ResponseRunOptions& options, const std::string& response_file = "");
