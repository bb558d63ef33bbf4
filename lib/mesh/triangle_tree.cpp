// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/mesh/triangle_tree.hpp>

#include <algorithm>
#include <numeric>

namespace skinbem {
namespace {

constexpr std::int32_t leaf_size = 4;

std::vector<std::int32_t> all_triangles(const TriangleMesh& mesh) {
  std::vector<std::int32_t> all(static_cast<std::size_t>(mesh.triangle_count()));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

}  // namespace

Box box_of_triangle(const TriangleMesh& mesh, Index t) {
  Box box(mesh.corner(t, 0));
  return box.extend(mesh.corner(t, 1)).extend(mesh.corner(t, 2));
}

TriangleTree::TriangleTree(const TriangleMesh& mesh) : TriangleTree(mesh, all_triangles(mesh)) {}

TriangleTree::TriangleTree(const TriangleMesh& mesh, std::vector<std::int32_t> triangles)
    : order_(std::move(triangles)) {
  for (const std::int32_t t : order_) boxes_.push_back(box_of_triangle(mesh, t));
  std::vector<std::int32_t> places(order_.size());
  std::iota(places.begin(), places.end(), 0);
  std::swap(order_, places);  // while building, order_ holds places in the caller's list
  nodes_.reserve(order_.size());
  if (!order_.empty()) build(0, static_cast<std::int32_t>(order_.size()));
  std::vector<Box> sorted;
  sorted.reserve(boxes_.size());
  for (std::int32_t& place : order_) {
    sorted.push_back(boxes_[place]);
    place = places[place];
  }
  boxes_ = std::move(sorted);
}

std::int32_t TriangleTree::build(std::int32_t begin, std::int32_t end) {
  const auto self = static_cast<std::int32_t>(nodes_.size());
  Box box, centres;
  for (std::int32_t i = begin; i < end; ++i) {
    box.extend(boxes_[order_[i]]);
    centres.extend(boxes_[order_[i]].center());
  }
  nodes_.push_back({box, begin, end, 0});
  if (end - begin <= leaf_size) return self;
  Index axis = 0;
  centres.sizes().maxCoeff(&axis);
  const std::int32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::int32_t i, std::int32_t j) {
                     const double ci = boxes_[i].min()(axis) + boxes_[i].max()(axis);
                     const double cj = boxes_[j].min()(axis) + boxes_[j].max()(axis);
                     return ci < cj || (ci == cj && i < j);
                   });
  build(begin, middle);
  const std::int32_t right = build(middle, end);
  nodes_[self].right = right;
  return self;
}

}  // namespace skinbem
