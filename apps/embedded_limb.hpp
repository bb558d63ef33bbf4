// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>
#include <vector>

/// A file of data/lower_limb, as it was when the program was configured.
struct EmbeddedFile {
  std::string_view name;  ///< relative to data/lower_limb, such as `bones/tibia.obj`
  std::string_view text;
};

const std::vector<EmbeddedFile>& embedded_limb();
