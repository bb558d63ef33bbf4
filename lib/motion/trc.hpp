// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Motion of markers on the body: the TRC format (Track Row Column).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <skinbem/base/types.hpp>

namespace skinbem {

struct TrcMotion {
  std::vector<std::string> markers;  ///< names, all different
  double rate = 0;                   ///< frames per second, > 0
  double first_time = 0;             ///< seconds, of the first frame
  Index first_frame = 0;             ///< number that the file gives its first frame; the numbers go up by one
  Eigen::MatrixXd positions;  ///< #frames (>= 1) by 3 #markers, marker-major x, y, z in millimetres; NaN: not seen

  Index frame_count() const { return positions.rows(); }
  /// Index of the marker called `name`, or -1.
  Index find(const std::string& name) const;
  /// Where marker `marker` is in frame `frame` (from 0); nothing when it was not seen.
  std::optional<Vec3> position(Index frame, Index marker) const;
};

/// Reads `path` strictly: fields separated by tabs, units mm, cm or m; an empty cell or NaN in all three of a marker
/// means not seen. Throws Error(io) when it cannot be read and Error(bad_input) "path:line: ..." for a header that is
/// not kept, a missing or superfluous field, something that is not a finite number, frames or times that do not go up
/// with the rate.
TrcMotion read_trc(const std::filesystem::path& path);

}  // namespace skinbem
