// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Small pictures of meshes, drawn without a display: a z-buffer, smooth shading, soft edges. The same input gives the
/// same bytes.
#pragma once

#include <filesystem>
#include <vector>

#include <skinbem/mesh/triangle_mesh.hpp>

namespace skinbem {

/// Colours are linear RGB in [0, 1].
using Colour = Eigen::Vector3f;

/// A mesh with how it is to be painted.
struct PictureMesh {
  TriangleMesh mesh;
  Colour colour{0.62f, 0.33f, 0.22f};
  std::vector<Colour> vertex_colours;  ///< #V, or empty: `colour` everywhere
  float opacity = 1;                   ///< below 1 the nearest surface is blended over what is opaque behind it
  bool smooth = true;                  ///< shading by vertex normals instead of triangle normals
};

inline const Colour skin_colour{0.66f, 0.36f, 0.25f};
inline const Colour bone_colour{0.80f, 0.72f, 0.55f};

/// Orthographic view along `direction`, with `up` upward on the picture (made orthogonal to `direction`).
struct Camera {
  Vec3 direction{0, 1, 0};
  Vec3 up{0, 0, 1};
};

struct PictureOptions {
  int width = 800, height = 800;  ///< of a picture, or of a contact sheet's cell, in pixels
  double margin = 0.05;           ///< left free on each side, as a share of the picture
  bool transparent = false;       ///< background: transparent, else white
  int samples = 3;                ///< by samples sub-pixels a pixel
  Colour floor_line{0.35f, 0.35f, 0.35f};
};

/// Pixels row by row from the top: red, green, blue (sRGB), alpha, a byte each.
struct Picture {
  int width = 0, height = 0;
  std::vector<unsigned char> rgba;
};

/// One picture of `meshes`, as large as fits. Throws Error(usage) for sizes below 1 or a degenerate camera.
Picture render(const std::vector<PictureMesh>& meshes, const Camera& camera, const PictureOptions& options = {});

/// Poses side by side at one scale, each centred in its cell, their heights kept, with a floor line at the lowest point
/// of all of them: a strip of a walking leg.
Picture contact_sheet(const std::vector<std::vector<PictureMesh>>& poses, const Camera& camera,
                      const PictureOptions& options = {});

/// Throws Error(io) when the file cannot be written.
void write_png(const std::filesystem::path& path, const Picture& picture);

/// A colour for each value, from `low` to `high` (clamped): dark blue over green to yellow, of lightness that grows
/// evenly with the value, so that equal steps look equal and a grey print still reads.
std::vector<Colour> colours_of(const Eigen::Ref<const Eigen::VectorXd>& values, double low, double high);

}  // namespace skinbem
