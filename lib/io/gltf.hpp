// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// An animated skin with its bones as binary glTF 2.0 (.glb).
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include <skinbem/io/animation.hpp>

namespace skinbem {

/// How the model looks and lies in the scene.
struct GltfOptions {
  double metres_per_unit = 0.001;  ///< of the mesh: glTF counts in metres, what we ship is in millimetres
  bool z_up = true;                ///< the mesh's z points up; glTF's up is y
  bool morph_normals = true;       ///< see write_glb
  double skin_opacity = 1;         ///< in (0, 1]; below 1 the bones show through
  std::array<double, 3> skin_colour{0.80, 0.56, 0.45};  ///< linear RGB
  std::array<double, 3> bone_colour{0.86, 0.80, 0.66};  ///< linear RGB
};

/// From this many morph targets on viewers get into trouble: three.js keeps them in a texture of #V x 16 bytes each.
inline constexpr Index gltf_target_limit = 200;

/// Writes one animation, whole or not at all, and returns warnings (empty when all is well).
///
/// * Node `model` turns and scales the mesh's coordinates into glTF's (metres, y up); all else is in mesh coordinates.
/// * Node `skin`: the columns of `targets` are its morph targets (names in `extras.targetNames`), `weights` its weights
///   track, `body` its translation and rotation tracks. A viewer that blends targets and applies the node's transform
///   computes the frame of the model itself, exactly at the given times, since the model is linear.
/// * A node per bone with its translation and rotation tracks.
/// * Interpolation is linear; time 0 is the first frame.
/// * Normals are area-weighted vertex normals; morph targets carry their derivative, so shading under deformation is
///   right to first order. Option `morph_normals = false` leaves it out and halves the size of the targets.
///
/// Throws what validate(skin, bones) throws, Error(usage) when the file would exceed 4 GiB or two times are the same in
/// float32, and Error(io) when it cannot be written.
std::vector<std::string> write_glb(const std::filesystem::path& path, const SkinAnimation& skin,
                                   const std::vector<MovingBone>& bones = {}, const GltfOptions& options = {});

}  // namespace skinbem
