// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What a cluster sees of its far field: the kernel between single vertices, and which of them to look at.
#pragma once

#include <vector>

#include <skinbem/base/aligned_buffer.hpp>
#include <skinbem/hmatrix/cluster_tree.hpp>
#include <skinbem/mesh/adjacency.hpp>
#include <skinbem/operator/collocation.hpp>

namespace skinbem {

/// The double layer's kernel T(x; y, n) from the centroids y of triangles, n their normals, to vertices x: such dipoles
/// stand for what hat functions do from afar. Vertices are named by their place in a tree.
template <class Kernel>
class PointKernel {
 public:
  static constexpr int components = Kernel::components;

  PointKernel(const TriangleMesh& mesh, const ClusterTree& tree, const Kernel& kernel);

  const Kernel& kernel() const { return kernel_; }
  /// Places, times a power of two that brings them near unit size.
  const Eigen::Vector3d& vertex(std::int32_t place) const { return vertices_[place]; }
  const Eigen::Vector3d& centroid(std::int32_t triangle) const { return centroids_[triangle]; }
  const Eigen::Vector3d& normal(std::int32_t triangle) const { return normals_[triangle]; }
  /// Values at `points` (places) of dipoles at `sources` (triangles): entry (i, j) of point p and source q is
  /// result[((p / kPanel #sources + q) components^2 + components i + j) kPanel + p % kPanel]. Valid until the next call
  /// of this thread.
  const double* values(std::span<const std::int32_t> points, std::span<const std::int32_t> sources) const;

 private:
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Eigen::Vector3d> centroids_;
  std::vector<Eigen::Vector3d> normals_;
  Kernel kernel_;
};

/// Some vertices of a cluster's far field, each standing for `area_root`^2 of its surface. The last kPanel of them are
/// drawn at random, to check what was made from the others.
struct FarSamples {
  std::vector<std::int32_t> places;     ///< a multiple of kPanel; those that fill up have no weight
  std::vector<std::int32_t> triangles;  ///< one at each
  std::vector<double> area_root;
};

/// What clusters see of their far fields: vertices of their own and their ancestors' partners, of each as many as befit
/// the solid angle that it fills.
class FarSampler {
 public:
  /// All of them are kept as references.
  FarSampler(const TriangleMesh& mesh, const ClusterTree& tree, const BlockPartition& partition);

  /// About `count` samples that are spread out, at most 32 of one partner, and those that check. Nothing where there is
  /// no far field. The same for the same arguments.
  FarSamples samples(std::int32_t cluster, Index count) const;

 private:
  struct Partner {
    std::int32_t cluster;
    double angle;  ///< solid, as the cluster that has it sees it
  };
  std::vector<Partner> partners_of(std::int32_t cluster) const;
  static double solid_angle(const std::vector<Partner>& partners);
  void add_spread_out(const std::vector<Partner>& partners, Index count, FarSamples& samples) const;
  void add_at_random(const std::vector<Partner>& partners, FarSamples& samples) const;

  const ClusterTree& tree_;
  const BlockPartition& partition_;
  IndexLists triangles_;
  std::vector<std::vector<std::int32_t>> representatives_;
  std::vector<double> areas_;  ///< of clusters
};

extern template class PointKernel<Kelvin<double>>;

}  // namespace skinbem
