// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/io/picture.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include <skinbem/base/error.hpp>
#include <skinbem/mesh/vertex_normals.hpp>

namespace skinbem {
namespace {

using Vec3f = Eigen::Vector3f;
using Mat3f = Eigen::Matrix3f;

/// Rows right, up, toward the viewer.
Mat3 view_axes(const Camera& camera) {
  const Vec3 back = -camera.direction.normalized();
  const Vec3 right = camera.up.cross(back).normalized();
  if (!back.allFinite() || !(right.norm() > 0.5)) {
    throw Error(ErrorCode::usage, "picture: the camera's direction and up must not be parallel");
  }
  Mat3 axes;
  axes << right.transpose(), back.cross(right).transpose(), back.transpose();
  return axes;
}

/// Light as a photographer would set it: a warm key from the upper left, a cool fill from the right, sky and ground.
/// `n` is the unit normal in view axes; the result multiplies the surface's colour, `gloss` is added to it.
struct Shade {
  Colour light;
  float gloss;
};

Shade shade(const Vec3f& n) {
  static const Vec3f key = Vec3f(-0.45f, 0.60f, 0.66f).normalized(), fill = Vec3f(0.80f, 0.10f, 0.55f).normalized();
  static const Vec3f half = (key + Vec3f::UnitZ()).normalized();
  const float sky = 0.5f + 0.5f * n.y();
  // The key is wrapped a little round the body: light scatters in skin, the terminator is soft.
  const float wrapped = std::max(0.0f, (n.dot(key) + 0.25f) / 1.25f);
  const Colour light = wrapped * Colour(0.98f, 0.93f, 0.87f) +
                       std::max(0.0f, n.dot(fill)) * Colour(0.16f, 0.18f, 0.22f) +
                       (1 - sky) * Colour(0.15f, 0.12f, 0.11f) + sky * Colour(0.28f, 0.30f, 0.33f);
  return {light, 0.10f * std::pow(std::max(0.0f, n.dot(half)), 24.0f)};
}

/// Colour premultiplied by its alpha, and the distance toward the viewer.
struct Sample {
  Colour colour = Colour::Zero();
  float alpha = 0;
  float depth = -std::numeric_limits<float>::infinity();
};

/// A grid of sub-pixels that triangles are drawn into; x to the right, y downward, depth toward the viewer.
class Canvas {
 public:
  Canvas(int width, int height) : width_(width), height_(height), samples_(static_cast<std::size_t>(width) * height) {}

  Sample& at(int x, int y) { return samples_[static_cast<std::size_t>(y) * width_ + x]; }
  const Sample& at(int x, int y) const { return samples_[static_cast<std::size_t>(y) * width_ + x]; }
  int width() const { return width_; }
  int height() const { return height_; }

  /// Keeps the nearest surface at each sub-pixel. `corners` holds x, y, depth by column; normals and colours likewise.
  void triangle(const Mat3f& corners, const Mat3f& normals, const Mat3f& colours, float opacity) {
    const Eigen::Vector2f a = corners.col(0).head<2>(), b = corners.col(1).head<2>(), c = corners.col(2).head<2>();
    const float area = (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
    if (area == 0) return;
    const auto range = [](float low, float high, int size) {
      return std::pair(std::clamp(static_cast<int>(std::floor(low)), 0, size),
                       std::clamp(static_cast<int>(std::ceil(high)) + 1, 0, size));
    };
    const auto [x0, x1] = range(corners.row(0).minCoeff(), corners.row(0).maxCoeff(), width_);
    const auto [y0, y1] = range(corners.row(1).minCoeff(), corners.row(1).maxCoeff(), height_);
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        const Eigen::Vector2f p(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        const float wb = ((p - a).x() * (c - a).y() - (p - a).y() * (c - a).x()) / area;
        const float wc = ((b - a).x() * (p - a).y() - (b - a).y() * (p - a).x()) / area;
        const Vec3f weights(1 - wb - wc, wb, wc);
        if (weights.minCoeff() < 0) continue;
        const float depth = corners.row(2).dot(weights);
        if (Sample& sample = at(x, y); depth > sample.depth) {
          sample = paint((normals * weights).normalized(), colours * weights, opacity, depth);
        }
      }
    }
  }

  /// Blends a canvas of one translucent layer over this one, where it is nearer to the viewer.
  void blend(const Canvas& layer) {
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const Sample& over = layer.samples_[i];
      Sample& under = samples_[i];
      if (over.alpha == 0 || over.depth < under.depth) continue;
      under = {over.colour + (1 - over.alpha) * under.colour, over.alpha + (1 - over.alpha) * under.alpha, over.depth};
    }
  }

 private:
  static Sample paint(const Vec3f& normal, const Colour& colour, float opacity, float depth) {
    // A thin layer is crossed at a slant near its outline, so it is denser there.
    const float slant = 1 - std::abs(normal.z());
    const float alpha = opacity >= 1 ? 1 : opacity + (1 - opacity) * 0.85f * slant * slant;
    const Shade s = shade(normal);
    return {alpha * (colour.cwiseProduct(s.light) + Colour::Constant(s.gloss)), alpha, depth};
  }

  int width_, height_;
  std::vector<Sample> samples_;
};

/// Where the view plane lies on the canvas: sub-pixels = scale * (right - left, top - up).
struct Frame {
  double scale, left, top;
};

void draw(Canvas& canvas, const PictureMesh& part, const Mat3& axes, const Frame& frame) {
  const Points view = part.mesh.vertices * axes.transpose();
  const Points normals = vertex_normals(part.mesh) * axes.transpose();
  for (Index t = 0; t < part.mesh.triangle_count(); ++t) {
    Mat3f corners, corner_normals, colours;
    for (int c = 0; c < 3; ++c) {
      const Index v = part.mesh.triangles(t, c);
      corners.col(c) << static_cast<float>(frame.scale * (view(v, 0) - frame.left)),
          static_cast<float>(frame.scale * (frame.top - view(v, 1))), static_cast<float>(view(v, 2));
      corner_normals.col(c) = normals.row(v).transpose().cast<float>();
      colours.col(c) = part.vertex_colours.empty() ? part.colour : part.vertex_colours[static_cast<std::size_t>(v)];
    }
    if (!part.smooth) {
      const Vec3 flat = axes * area_vector(part.mesh, t).normalized();
      corner_normals.colwise() = flat.cast<float>().eval();
    }
    canvas.triangle(corners, corner_normals, colours, part.opacity);
  }
}

void draw_all(Canvas& canvas, const std::vector<PictureMesh>& meshes, const Mat3& axes, const Frame& frame) {
  for (const PictureMesh& part : meshes) {
    if (part.opacity >= 1) draw(canvas, part, axes, frame);
  }
  for (const PictureMesh& part : meshes) {
    if (part.opacity >= 1) continue;
    Canvas layer(canvas.width(), canvas.height());
    draw(layer, part, axes, frame);
    canvas.blend(layer);
  }
}

/// Extent of the meshes in view axes.
Eigen::AlignedBox3d extent(const std::vector<PictureMesh>& meshes, const Mat3& axes) {
  Eigen::AlignedBox3d box;
  for (const PictureMesh& part : meshes) {
    const Points view = part.mesh.vertices * axes.transpose();
    for (Index v = 0; v < view.rows(); ++v) box.extend(Vec3(view.row(v)));
  }
  return box;
}

unsigned char srgb_byte(float linear) {
  const float v = std::clamp(linear, 0.0f, 1.0f);
  const float s = v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
  return static_cast<unsigned char>(std::lround(255 * s));
}

/// Averages the sub-pixels in linear light and puts them on the background.
void resolve(const Canvas& canvas, const PictureOptions& options, int left, Picture& picture) {
  const int s = options.samples;
  for (int y = 0; y < options.height; ++y) {
    for (int x = 0; x < options.width; ++x) {
      Colour colour = Colour::Zero();
      float alpha = 0;
      for (int i = 0; i < s * s; ++i) {
        const Sample& sample = canvas.at(x * s + i % s, y * s + i / s);
        colour += sample.colour / static_cast<float>(s * s);
        alpha += sample.alpha / static_cast<float>(s * s);
      }
      if (!options.transparent) {
        colour += Colour::Constant(1 - alpha);
        alpha = 1;
      } else if (alpha > 0) {
        colour /= alpha;
      }
      unsigned char* pixel = &picture.rgba[4 * (static_cast<std::size_t>(y) * picture.width + left + x)];
      for (int c = 0; c < 3; ++c) pixel[c] = srgb_byte(colour[c]);
      pixel[3] = static_cast<unsigned char>(std::lround(255 * alpha));
    }
  }
}

void require_valid(const PictureOptions& options) {
  if (options.width < 1 || options.height < 1 || options.samples < 1 ||
      !(options.margin >= 0 && options.margin < 0.5)) {
    throw Error(ErrorCode::usage, "picture: width, height and samples must be positive and the margin in [0, 0.5)");
  }
}

Picture empty_picture(int width, int height) {
  return {width, height, std::vector<unsigned char>(4 * static_cast<std::size_t>(width) * height)};
}

/// The largest scale at which `size` (width, height) fits.
double fitting_scale(const Vec3& size, const PictureOptions& options) {
  const double room = (1 - 2 * options.margin) * options.samples;
  const double scale = std::min(room * options.width / size.x(), room * options.height / size.y());
  return std::isfinite(scale) && scale > 0 ? scale : 1;
}

void draw_floor(Canvas& canvas, const PictureOptions& options, double y) {
  const int thickness = options.samples, top = static_cast<int>(std::lround(y));
  for (int row = std::max(top, 0); row < std::min(top + thickness, canvas.height()); ++row) {
    for (int x = 0; x < canvas.width(); ++x) {
      if (Sample& sample = canvas.at(x, row); sample.alpha == 0) sample = {options.floor_line, 1, sample.depth};
    }
  }
}

}  // namespace

Picture render(const std::vector<PictureMesh>& meshes, const Camera& camera, const PictureOptions& options) {
  require_valid(options);
  const Mat3 axes = view_axes(camera);
  const Eigen::AlignedBox3d box = extent(meshes, axes);
  Picture picture = empty_picture(options.width, options.height);
  Canvas canvas(options.width * options.samples, options.height * options.samples);
  if (!box.isEmpty()) {
    const double scale = fitting_scale(box.sizes(), options);
    const Vec3 centre = box.center();
    draw_all(canvas, meshes, axes,
             {scale, centre.x() - canvas.width() / (2 * scale), centre.y() + canvas.height() / (2 * scale)});
  }
  resolve(canvas, options, 0, picture);
  return picture;
}

Picture contact_sheet(const std::vector<std::vector<PictureMesh>>& poses, const Camera& camera,
                      const PictureOptions& options) {
  require_valid(options);
  const Mat3 axes = view_axes(camera);
  std::vector<Eigen::AlignedBox3d> boxes;
  double widest = 0, bottom = std::numeric_limits<double>::infinity(), top = -bottom;
  for (const std::vector<PictureMesh>& pose : poses) {
    boxes.push_back(extent(pose, axes));
    if (boxes.back().isEmpty()) throw Error(ErrorCode::usage, "picture: a pose of the contact sheet has no mesh");
    widest = std::max(widest, boxes.back().sizes().x());
    bottom = std::min(bottom, boxes.back().min().y());
    top = std::max(top, boxes.back().max().y());
  }
  const double scale = fitting_scale(Vec3(widest, top - bottom, 0), options);
  Picture picture = empty_picture(options.width * static_cast<int>(poses.size()), options.height);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    Canvas canvas(options.width * options.samples, options.height * options.samples);
    const double left = boxes[i].center().x() - canvas.width() / (2 * scale);
    const double upper = (bottom + top) / 2 + canvas.height() / (2 * scale);
    draw_all(canvas, poses[i], axes, {scale, left, upper});
    draw_floor(canvas, options, scale * (upper - bottom));
    resolve(canvas, options, options.width * static_cast<int>(i), picture);
  }
  return picture;
}

}  // namespace skinbem
