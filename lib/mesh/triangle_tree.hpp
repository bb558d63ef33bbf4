// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A tree of boxes around the triangles of a mesh.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include <skinbem/mesh/triangle_mesh.hpp>

namespace skinbem {

using Box = Eigen::AlignedBox3d;

/// The box around triangle `t`.
Box box_of_triangle(const TriangleMesh& mesh, Index t);

/// Binary tree over triangles, halved at the median of their box centres along the longest side. Holds indices only:
/// the mesh stays the caller's. Coordinates must be finite.
class TriangleTree {
 public:
  struct Node {
    Box box;
    std::int32_t begin = 0, end = 0;  ///< its triangles in order()
    std::int32_t right = 0;           ///< right child; the left one is the next node; 0 for a leaf
    bool is_leaf() const { return right == 0; }
  };

  /// Over all triangles, or over those listed.
  explicit TriangleTree(const TriangleMesh& mesh);
  TriangleTree(const TriangleMesh& mesh, std::vector<std::int32_t> triangles);

  /// Nodes in depth-first order, the root first; empty without triangles.
  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<std::int32_t>& order() const { return order_; }
  std::span<const std::int32_t> triangles_of(const Node& node) const {
    return {order_.data() + node.begin, order_.data() + node.end};
  }

  /// Calls visit(i, j) once for every pair of different triangles whose boxes touch, until it returns false.
  template <class Visit>
  void for_each_close_pair(Visit&& visit) const {
    if (!nodes_.empty()) close_pairs(0, 0, visit);
  }

 private:
  std::int32_t build(std::int32_t begin, std::int32_t end);

  template <class Visit>
  bool close_pairs(std::int32_t a, std::int32_t b, Visit& visit) const {
    const Node &na = nodes_[a], &nb = nodes_[b];
    if (a != b && !na.box.intersects(nb.box)) return true;
    if (na.is_leaf() && nb.is_leaf()) {
      for (std::int32_t i = na.begin; i < na.end; ++i) {
        for (std::int32_t j = a == b ? i + 1 : nb.begin; j < nb.end; ++j) {
          if (boxes_[i].intersects(boxes_[j]) && !visit(order_[i], order_[j])) return false;
        }
      }
      return true;
    }
    if (a == b) {
      return close_pairs(a + 1, a + 1, visit) && close_pairs(a + 1, na.right, visit) &&
             close_pairs(na.right, na.right, visit);
    }
    const bool split_a = nb.is_leaf() || (!na.is_leaf() && na.end - na.begin >= nb.end - nb.begin);
    if (split_a) return close_pairs(a + 1, b, visit) && close_pairs(na.right, b, visit);
    return close_pairs(a, b + 1, visit) && close_pairs(a, nb.right, visit);
  }

  std::vector<Node> nodes_;
  std::vector<std::int32_t> order_;
  std::vector<Box> boxes_;  // of the triangles, in order_
};

}  // namespace skinbem
