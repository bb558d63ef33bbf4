// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Animations as a mesh file a frame.
#pragma once

#include <filesystem>
#include <vector>

#include <skinbem/base/progress.hpp>
#include <skinbem/io/animation.hpp>

namespace skinbem {

/// Writes skin_000000.obj, ... and, where there are bones, bones_000000.obj, ... into `folder`, which is replaced as a
/// whole and only if it held such a sequence (frame_folder.hpp). Vertex order is that of the rest meshes.
/// Throws what validate(skin, bones) throws, Error(io) and Error(cancelled).
void write_obj_sequence(const std::filesystem::path& folder, const SkinAnimation& skin,
                        const std::vector<MovingBone>& bones = {}, const Progress& progress = {});

}  // namespace skinbem
