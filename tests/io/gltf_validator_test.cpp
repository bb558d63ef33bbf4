// SPDX-License-Identifier: BSD-3-Clause
// Khronos' own validator (npm package gltf-validator) finds nothing to say about our files. Runs where node and the
// package are found: in NODE_PATH, or in node_modules of the build folder or the checkout.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>

#include <skinbem/base/atomic_file.hpp>
#include <skinbem/io/gltf.hpp>

#include "files.hpp"
#include "small_animation.hpp"

namespace skinbem {
namespace {

using testing_support::small_bones;
using testing_support::small_skin;
using testing_support::TemporaryFolder;

std::string output_of(const std::string& command) {
  std::string output;
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return output;
  std::array<char, 4096> part;
  while (const std::size_t n = fread(part.data(), 1, part.size(), pipe)) output.append(part.data(), n);
  pclose(pipe);
  return output;
}

std::string node_with_modules() {
  const char* path = std::getenv("NODE_PATH");
  return std::string("NODE_PATH='") + (path ? path : "") +
         ":" SKINBEM_TEST_BINARY_DIR "/node_modules:" + SKINBEM_TEST_SOURCE_DIR "/node_modules' node ";
}

class GltfValidator : public testing::Test {
 protected:
  void SetUp() override {
    const std::string node = node_with_modules();
    if (output_of(node + "-e \"require('gltf-validator'); console.log('found')\" 2>/dev/null") != "found\n") {
      GTEST_SKIP() << "needs node and the npm package gltf-validator; set NODE_PATH";
    }
  }

  void expect_clean(const SkinAnimation& skin, const std::vector<MovingBone>& bones, const GltfOptions& options = {}) {
    write_glb(folder_ / "a.glb", skin, bones, options);
    write_file_atomically(folder_ / "check.js", [](std::ostream& out) {
      out << "const bytes = new Uint8Array(require('fs').readFileSync(process.argv[2]));\n"
             "require('gltf-validator').validateBytes(bytes).then(r => {\n"
             "  const i = r.issues;\n"
             "  console.log(i.numErrors + i.numWarnings ? JSON.stringify(i.messages, null, 1) : 'clean');\n"
             "}, e => console.log(String(e)));\n";
    });
    EXPECT_EQ(output_of(node_with_modules() + (folder_ / "check.js").string() + " " + (folder_ / "a.glb").string()),
              "clean\n");
  }
  TemporaryFolder folder_;
};

TEST_F(GltfValidator, FindsNothingInOneFrame) { expect_clean(small_skin(1), {}); }
TEST_F(GltfValidator, FindsNothingInManyFramesWithBones) { expect_clean(small_skin(300), small_bones(300)); }
TEST_F(GltfValidator, FindsNothingInAStiffSkin) { expect_clean(small_skin(3, 0), small_bones(3)); }
TEST_F(GltfValidator, FindsNothingInATranslucentSkinWithoutMorphNormals) {
  GltfOptions options;
  options.skin_opacity = 0.5;
  options.morph_normals = false;
  expect_clean(small_skin(20), small_bones(20), options);
}

}  // namespace
}  // namespace skinbem
