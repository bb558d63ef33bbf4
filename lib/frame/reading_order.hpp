// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// In which order single frames read a model that no cache holds. Offline; internal to the floor.
#pragma once

#include <cstddef>

#include <skinbem/frame/panel_product.hpp>

namespace skinbem::detail {

/// Models of fewer bytes are read one panel after the other: from caches, turns gained nothing on any machine.
inline constexpr std::size_t kLeastBytesInTurns = std::size_t{16} << 20;

/// Whether single frames of `matrix`, which takes `bytes` and has `weights` columns, are faster with panels in turns
/// than with one panel after the other. From memory this is a matter of the processor, so both are timed on the model
/// itself, three frames each, the best of either; models below kLeastBytesInTurns are not timed. The bits of a frame do
/// not depend on the answer.
bool faster_in_turns(PanelMatrix matrix, std::size_t bytes, std::size_t weights);

}  // namespace skinbem::detail
