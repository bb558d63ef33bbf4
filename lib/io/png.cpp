// SPDX-License-Identifier: BSD-3-Clause
#include <png.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <skinbem/base/atomic_file.hpp>
#include <skinbem/base/error.hpp>
#include <skinbem/io/picture.hpp>

namespace skinbem {
namespace {

/// Linear RGB of a colour in Oklab (B. Ottosson, "A perceptual color space for image processing", 2020), clamped.
Colour from_oklab(double lightness, double a, double b) {
  const Vec3 root(lightness + 0.3963377774 * a + 0.2158037573 * b, lightness - 0.1055613458 * a - 0.0638541728 * b,
                  lightness - 0.0894841775 * a - 1.2914855480 * b);
  const Vec3 cone = root.array().cube();
  const Vec3 rgb(4.0767416621 * cone[0] - 3.3077115913 * cone[1] + 0.2309699292 * cone[2],
                 -1.2684380046 * cone[0] + 2.6097574011 * cone[1] - 0.3413193965 * cone[2],
                 -0.0041960863 * cone[0] - 0.7034186147 * cone[1] + 1.7076147010 * cone[2]);
  return rgb.cwiseMax(0).cwiseMin(1).cast<float>();
}

}  // namespace

std::vector<Colour> colours_of(const Eigen::Ref<const Eigen::VectorXd>& values, double low, double high) {
  std::vector<Colour> colours;
  colours.reserve(static_cast<std::size_t>(values.size()));
  for (double value : values) {
    const double s = high > low ? std::clamp((value - low) / (high - low), 0.0, 1.0) : 0;
    const double hue = (285 - 180 * s) * std::numbers::pi / 180, chroma = 0.11 + 0.05 * s;
    colours.push_back(from_oklab(0.32 + 0.58 * s, chroma * std::cos(hue), chroma * std::sin(hue)));
  }
  return colours;
}

void write_png(const std::filesystem::path& path, const Picture& picture) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGBA;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::vector<char> bytes(size);
  if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, picture.rgba.data(), 0, nullptr)) {
    throw Error(ErrorCode::io, path.string() + ": cannot make a PNG: " + image.message);
  }
  write_file_atomically(path, [&](std::ostream& out) { out.write(bytes.data(), static_cast<std::streamsize>(size)); });
}

}  // namespace skinbem
