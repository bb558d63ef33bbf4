// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Animations for ParaView.
#pragma once

#include <filesystem>
#include <vector>

#include <skinbem/base/progress.hpp>
#include <skinbem/io/animation.hpp>

namespace skinbem {

/// Writes `path` (OUT.pvd) and, in the folder OUT_frames beside it, a VTP file per frame for the skin (part 0, point
/// data `displacement` against rest) and, where there are bones, one for all of them (part 1). Points are float32 in
/// mesh coordinates, data is appended raw binary, times are those of the animation.
/// The folder is replaced as a whole and OUT.pvd last, so a failure leaves an older result as it was.
/// Throws what validate(skin, bones) throws, Error(io) and Error(cancelled).
void write_vtk_sequence(const std::filesystem::path& path, const SkinAnimation& skin,
                        const std::vector<MovingBone>& bones = {}, const Progress& progress = {});

/// Writes one mesh as VTP; `displacement` is #V by 3 or empty.
void write_vtp(const std::filesystem::path& path, const TriangleMesh& mesh, const Points& displacement = {});

}  // namespace skinbem
