// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/packing.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace skinbem::detail {
namespace {

constexpr auto kWidth = static_cast<Index>(kPanelWidth);
constexpr int kLargestInt = 32767;

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

/// As many as there are columns in order, or whole lines of them.
std::uint32_t adjacent_entries(const std::vector<QuantisedEntry>& entries) {
  std::size_t count = 1;
  while (count < entries.size() && entries[count].column == entries[count - 1].column + 1) ++count;
  return static_cast<std::uint32_t>(count >= entries.size() ? entries.size() : count / 16 * 16);
}

void append_entries(const std::vector<QuantisedEntry>& entries, const PanelPlace& place,
                    AlignedVector<std::byte>& data) {
  const std::size_t begin = data.size(), list = entry_list_bytes(place.entries, place.adjacent);
  data.resize(begin + list + (entries.size() + 1) / 2 * kColumnPairBytes);  // zeros
  auto* scale = reinterpret_cast<float*>(data.data() + begin);
  auto* which = reinterpret_cast<std::uint32_t*>(scale + padded_entries(entries.size()));
  auto* numbers = reinterpret_cast<std::int16_t*>(data.data() + begin + list);
  for (std::size_t e = 0; e < entries.size(); ++e) {
    scale[e] = entries[e].scale / place.scale;
    if (e >= place.adjacent) which[e - place.adjacent] = entries[e].column;
    std::int16_t* pair = numbers + e / 2 * (2 * kColumnNumbers) + e % 2;
    for (std::size_t i = 0; i < kColumnNumbers; ++i) pair[2 * i] = entries[e].numbers[i];
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
  QuantisedEntry entry{column, static_cast<float>(remainder.cwiseAbs().maxCoeff() / kLargestInt)};
  if (!(entry.scale >= std::numeric_limits<float>::min())) entry.scale = 0;
  if (entry.scale == 0) return entry;
  const double unit = entry.scale;
  for (Index i = 0; i < remainder.size(); ++i) {
    const long number = std::clamp(std::lround(remainder[i] / unit), -long{kLargestInt}, long{kLargestInt});
    entry.numbers[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(number);
    remainder[i] -= unit * static_cast<double>(number);
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
  float largest = std::numeric_limits<float>::min();
  for (const QuantisedEntry& entry : entries) largest = std::max(largest, entry.scale);
  const float scale = std::ldexp(1.0F, std::ilogb(largest) + 1);
  packed.places.push_back({packed.data.size(), entries.size(), adjacent_entries(entries),
                           entries.empty() ? 0 : entries.front().column, scale});
  append_rest(rest, p, packed.data);
  append_entries(entries, packed.places.back(), packed.data);
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
