// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/io/picture.hpp>

#include <gtest/gtest.h>

#include <skinbem/base/atomic_file.hpp>
#include <skinbem/base/error.hpp>

#include "files.hpp"
#include "small_animation.hpp"

namespace skinbem {
namespace {

using testing_support::octahedron;
using testing_support::TemporaryFolder;

PictureOptions small_options() {
  PictureOptions options;
  options.width = options.height = 40;
  options.transparent = true;
  return options;
}

const unsigned char* pixel(const Picture& picture, int x, int y) { return &picture.rgba[4 * (y * picture.width + x)]; }

PictureMesh painted(double radius, const Colour& colour, float opacity = 1) {
  return {octahedron(radius), colour, {}, opacity, true};
}

TEST(Picture, CoversTheOutlineAndLeavesTheCornersFree) {
  const Picture picture = render({painted(1, {1, 0, 0})}, Camera{}, small_options());
  EXPECT_EQ(pixel(picture, 20, 20)[3], 255);
  EXPECT_GT(pixel(picture, 20, 20)[0], pixel(picture, 20, 20)[2]);
  for (int corner : {0, 39}) EXPECT_EQ(pixel(picture, corner, corner)[3], 0);
}

TEST(Picture, ShowsTheNearerMeshWhateverTheOrder) {
  PictureMesh far = painted(1, {1, 0, 0}), near = painted(1, {0, 0, 1});
  near.mesh.vertices.col(1).array() -= 5;  // the camera looks along +y
  for (const auto& order : {std::vector{far, near}, std::vector{near, far}}) {
    const Picture picture = render(order, Camera{}, small_options());
    EXPECT_GT(pixel(picture, 20, 20)[2], pixel(picture, 20, 20)[0]);
  }
}

TEST(Picture, ATranslucentSkinLetsTheBoneShowThrough) {
  const Picture with = render({painted(1, {1, 0, 0}, 0.4f), painted(0.4, {0, 0, 1})}, Camera{}, small_options());
  const Picture without = render({painted(1, {1, 0, 0}, 0.4f)}, Camera{}, small_options());
  EXPECT_EQ(pixel(with, 20, 20)[3], 255);
  EXPECT_LT(pixel(without, 20, 20)[3], 255);
  EXPECT_GT(pixel(with, 20, 20)[2], pixel(without, 20, 20)[2]);
}

TEST(Picture, IsTheSameEveryTimeAndOfTheSizeAsked) {
  const std::vector<std::vector<PictureMesh>> poses{{painted(1, skin_colour)}, {painted(0.5, bone_colour)}};
  const Picture sheet = contact_sheet(poses, Camera{}, small_options());
  EXPECT_EQ(sheet.width, 80);
  EXPECT_EQ(sheet.height, 40);
  EXPECT_EQ(sheet.rgba, contact_sheet(poses, Camera{}, small_options()).rgba);
}

TEST(Picture, RefusesASenselessCameraAndSize) {
  EXPECT_THROW(render({}, Camera{Vec3(0, 0, 1), Vec3(0, 0, 1)}, small_options()), Error);
  PictureOptions options = small_options();
  options.width = 0;
  EXPECT_THROW(render({}, Camera{}, options), Error);
}

TEST(Picture, PngStatesItsSize) {
  TemporaryFolder folder;
  write_png(folder / "a.png", render({painted(1, skin_colour)}, Camera{}, small_options()));
  const std::string file = read_file(folder / "a.png");
  EXPECT_EQ(file.substr(1, 3), "PNG");
  EXPECT_EQ(file.substr(16, 8), std::string("\0\0\0\x28\0\0\0\x28", 8));
}

TEST(Colours, GrowLighterWithTheValue) {
  const auto colours = colours_of(Eigen::VectorXd::LinSpaced(50, -1, 3), -1, 3);
  const Colour luminance(0.2126f, 0.7152f, 0.0722f);
  for (std::size_t i = 1; i < colours.size(); ++i) EXPECT_GT(luminance.dot(colours[i]), luminance.dot(colours[i - 1]));
}

}  // namespace
}  // namespace skinbem
