// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <skinbem/io/npy.hpp>

#include "commands.hpp"
#include "console.hpp"
#include "response_run.hpp"

namespace {

struct Options {
  ResponseRunOptions run;
  std::string output;
  bool float32 = false;
};

void response(const Options& options) {
  require_writable_file(options.output, {options.run.mesh, options.run.landmarks});
  const ResponseRun run = run_response(options.run);
  skinbem::write_npy(options.output, run.response,
                     options.float32 ? skinbem::NpyType::float32 : skinbem::NpyType::float64);
  if (options.run.json) {
    fmt::print("{}\n", skinbem::to_json(run.report));
  } else {
    fmt::print("{}response   {} by {} in {}\n", skinbem::to_text(run.report), run.response.rows(), run.response.cols(),
               options.output);
  }
}

}  // namespace

void add_response(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("response", "The response matrix of a mesh and its landmarks");
  add_response_options(*command, options->run);
  command->add_option("-o,--output", options->output, "R.npy: 3 vertices by 3 landmarks, C order")->required();
  command->add_flag("--float32", options->float32, "Write float32 instead of float64");
  command->footer("Example: skinbem response skin.obj --landmarks landmarks.csv --radius 15 -o R.npy");
  command->callback([options] { response(*options); });
}
