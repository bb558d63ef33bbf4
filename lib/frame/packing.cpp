// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/packing.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace skinbem::detail {
namespace {

constexpr auto kWidth = static_cast<Index>(kPanelWidth);
constexpr double kLargestInt = 32766;  // one less than int16 has: the fraction of a lower half may round away from zero

std::size_t panel_count(const Points& rest) {
  return (static_cast<std::size_t>(rest.rows()) + kPanelWidth - 1) / kPanelWidth;
}

/// Row of a panel's column that holds component c of its vertex i: components apart.
Index slot(Index i, Index c) { return c * kWidth + i; }

void append_rest(const Points& rest, std::size_t p, AlignedVector<std::byte>& data) {
  float values[kColumnNumbers] = {};
  const Index first = static_cast<Index>(p) * kWidth;
  for (Index i = 0; i < std::min(kWidth, rest.rows() - first); ++i) {
    for (Index c = 0; c < 3; ++c) values[slot(i, c)] = static_cast<float>(rest(first + i, c));
  }
  const auto* bytes = reinterpret_cast<const std::byte*>(values);
  data.insert(data.end(), bytes, bytes + sizeof(values));
}

/// Frobenius norms of the 3 by 3 blocks of `error` (a panel): 32 by #landmarks.
Eigen::MatrixXd block_norms(const Eigen::MatrixXd& error) {
  Eigen::MatrixXd norms(kWidth, error.cols() / 3);
  for (Index k = 0; k < norms.cols(); ++k) {
    const auto squares = error.middleCols<3>(3 * k).rowwise().squaredNorm().eval();
    norms.col(k) = (squares.head(kWidth) + squares.segment(kWidth, kWidth) + squares.tail(kWidth)).cwiseSqrt();
  }
  return norms;
}

void append_entries(const std::vector<QuantisedEntry>& entries, AlignedVector<std::byte>& data) {
  const std::size_t begin = data.size();
  const std::size_t list = entry_list_bytes(entries.size());
  data.resize(begin + list + entries.size() * kQuantisedColumnBytes);
  std::byte* which = data.data() + begin;
  std::byte* scale = which + entries.size() * sizeof(std::uint32_t);
  std::byte* numbers = which + list;
  for (const QuantisedEntry& entry : entries) {
    std::memcpy(which, &entry.column, sizeof(entry.column));
    std::memcpy(scale, &entry.scale, sizeof(entry.scale));
    std::memcpy(numbers, entry.words.data(), kQuantisedColumnBytes);
    which += sizeof(entry.column);
    scale += sizeof(entry.scale);
    numbers += kQuantisedColumnBytes;
  }
}

}  // namespace

Eigen::MatrixXd panel_of(const Eigen::MatrixXd& matrix, std::size_t p) {
  const Index first = static_cast<Index>(p) * kWidth;
  const Index count = std::min(kWidth, matrix.rows() / 3 - first);
  Eigen::MatrixXd panel = Eigen::MatrixXd::Zero(3 * kWidth, matrix.cols());
  for (Index i = 0; i < count; ++i) {
    for (Index c = 0; c < 3; ++c) panel.row(slot(i, c)) = matrix.row(3 * (first + i) + c);
  }
  return panel;
}

QuantisedEntry quantise(std::uint32_t column, Eigen::Ref<Eigen::VectorXd> remainder) {
  QuantisedEntry entry{column, static_cast<float>(std::ldexp(remainder.cwiseAbs().maxCoeff() / kLargestInt, -16))};
  if (!(entry.scale >= std::numeric_limits<float>::min())) entry.scale = 0;
  if (entry.scale == 0) return entry;
  const double unit = std::ldexp(double{entry.scale}, 16);
  for (Index c = 0; c < 3; ++c) {
    for (Index i = 0; i < kWidth / 2; ++i) {
      double& lower = remainder(slot(i, c));
      double& upper = remainder(slot(i + kWidth / 2, c));
      const auto low = static_cast<std::int32_t>(std::lround(lower / unit));
      const double fraction = std::ldexp(static_cast<double>(low & 0xffff), -16);
      const auto high = static_cast<std::int32_t>(std::lround(upper / unit - fraction));
      entry.words[static_cast<std::size_t>(c * kWidth / 2 + i)] = static_cast<std::int32_t>(
          static_cast<std::uint32_t>(high) << 16 | (static_cast<std::uint32_t>(low) & 0xffffU));
      lower -= unit * low;
      upper -= unit * (high + fraction);
    }
  }
  return entry;
}

std::vector<QuantisedEntry> quantise_panel(Eigen::MatrixXd& panel, std::size_t first_column, double error_factor,
                                           double& achieved) {
  std::vector<QuantisedEntry> entries;
  const auto add = [&](Index k) {
    entries.push_back(quantise(static_cast<std::uint32_t>(first_column) + static_cast<std::uint32_t>(k), panel.col(k)));
  };
  for (Index k = 0; k < panel.cols(); ++k) add(k);
  for (;;) {
    const Eigen::MatrixXd norms = block_norms(panel);
    Index vertex = 0;
    const double worst = norms.rowwise().sum().maxCoeff(&vertex);
    Index landmark = 0;
    norms.row(vertex).maxCoeff(&landmark);
    if (worst <= error_factor || !(norms(vertex, landmark) > 0)) {
      achieved = std::max(achieved, worst);
      return entries;
    }
    for (Index k = 3 * landmark; k < 3 * landmark + 3; ++k) add(k);
  }
}

double error_factor_of(const Eigen::MatrixXd& error) { return block_norms(error).rowwise().sum().maxCoeff(); }

void append_panel(const Points& rest, std::size_t p, const std::vector<QuantisedEntry>& entries, PackedPanels& packed) {
  packed.places.push_back({packed.data.size(), entries.size()});
  append_rest(rest, p, packed.data);
  append_entries(entries, packed.data);
}

PackedPanels pack_float32(const Points& rest, const Eigen::MatrixXd& response) {
  PackedPanels packed;
  packed.vertices = static_cast<std::size_t>(rest.rows());
  packed.data.reserve(panel_count(rest) * kRestBytes * static_cast<std::size_t>(response.cols() + 1));
  for (std::size_t p = 0; p < panel_count(rest); ++p) {
    packed.places.push_back({packed.data.size(), static_cast<std::size_t>(response.cols())});
    append_rest(rest, p, packed.data);
    const Eigen::MatrixXf panel = panel_of(response, p).cast<float>();
    const auto* bytes = reinterpret_cast<const std::byte*>(panel.data());
    packed.data.insert(packed.data.end(), bytes, bytes + panel.size() * static_cast<Index>(sizeof(float)));
  }
  return packed;
}

PackedPanels pack_int16(const Points& rest, const Eigen::MatrixXd& response, double error_factor,
                        Eigen::MatrixXd* error) {
  PackedPanels packed;
  packed.vertices = static_cast<std::size_t>(rest.rows());
  packed.quantised = true;
  if (error) error->resizeLike(response);
  for (std::size_t p = 0; p < panel_count(rest); ++p) {
    Eigen::MatrixXd panel = panel_of(response, p);
    append_panel(rest, p, quantise_panel(panel, 0, error_factor, packed.error_factor), packed);
    const Index first = static_cast<Index>(p) * kWidth;
    for (Index i = 0; error && i < std::min(kWidth, rest.rows() - first); ++i) {
      for (Index c = 0; c < 3; ++c) error->row(3 * (first + i) + c) = panel.row(slot(i, c));
    }
  }
  return packed;
}

}  // namespace skinbem::detail
