// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Every vertex a handle: grab, pull and release any place of the skin within a frame.
///
///     ResponseModel body(mesh);                                  // offline, once; throws Error
///     const HandleModel model(body);                             // the Green's functions of all vertices
///     Handles handles(model, std::vector{12, 100, 431}, 16);     // one for each character; anchors at rest
///     handles.grab(77);                                          // the skin stays as it is
///     handles.pull(3, {0, 0, 10});                               // handle 3, the fourth, goes 10 up
///     handles.evaluate(VertexTarget{positions});
///     handles.release(3);                                        // that place is free again
#pragma once

#include <span>
#include <vector>

#include <skinbem/frame/capacitance.hpp>
#include <skinbem/frame/column_panels.hpp>
#include <skinbem/frame/frame_threads.hpp>
#include <skinbem/frame/handle_model.hpp>
#include <skinbem/frame/vertex_buffer.hpp>

namespace skinbem {

/// The handles of one character and the skin that follows them: u = X t + B a, where t and a solve the small system of
/// response_model.hpp, whose inverse is kept and bordered when a handle comes or goes. The same displacements as R u_K
/// of a ResponseModel with these landmarks, to single precision. Linear: displacements are in the frame of the body,
/// which set_body_motion moves.
///
/// After construction nothing allocates, locks or throws. What is refused returns false and changes nothing. Refers to
/// its model, which must outlive it. Distinct objects may be used from distinct threads at once.
class Handles {
 public:
  /// Handles on `vertices`, at rest, and room for `most` in all. Throws Error(usage) for a vertex that does not exist,
  /// two handles on one, or fewer places than handles; Error(bad_input) for fewer than three, or all on a line.
  Handles(const HandleModel& model, std::span<const std::int32_t> vertices, Index most = 32);

  Index count() const noexcept { return count_; }
  /// The vertex of handle k.
  std::int32_t vertex(Index k) const noexcept { return vertices_[static_cast<std::size_t>(k)]; }
  /// Prescribed displacement of handle k, unit of the mesh, frame of the body.
  Vec3 displacement(Index k) const noexcept { return displacements_.segment<3>(3 * k); }

  /// A new handle, the last, where the skin is now: the skin stays as it is until the handle is pulled. False where
  /// there is no such vertex, it has a handle, or there is no room.
  bool grab(std::int32_t vertex) noexcept;
  /// Prescribes the displacement of handle k. False where there is no such handle, or the displacement is not finite
  /// or beyond 1e12.
  bool pull(Index k, const Vec3& displacement) noexcept;
  /// The same for all handles at once: #K by 3.
  bool pull(const Eigen::Ref<const Points>& displacements) noexcept;
  /// Lets go of handle k; those behind it move up, and the skin follows those that are left. False where there is no
  /// such handle, or what is left is fewer than three handles or lies on a line.
  bool release(Index k) noexcept;
  /// Lets go of handle k and takes hold of `vertex` where the skin is now; the handle keeps its number. False under the
  /// conditions of grab and release.
  bool move(Index k, std::int32_t vertex) noexcept;

  /// (Q, t): where the body's frame is; a frame is Q (X + u) + t. False where it is not finite or not a rotation.
  bool set_body_motion(const RigidMotion& motion) noexcept;

  /// Writes the positions of all vertices: always finite. Returns false and writes nothing unless the attribute holds
  /// them.
  bool evaluate(const VertexTarget& positions) const noexcept;
  /// The same with the help of other threads where the skin is large enough to gain by it; the same bits.
  bool evaluate(const VertexTarget& positions, FrameThreads& threads) const noexcept;

 private:
  static void check(const HandleModel& model, std::span<const std::int32_t> vertices, Index most);
  static Eigen::MatrixXd system_of(const HandleModel& model, std::span<const std::int32_t> vertices);
  bool append(std::int32_t vertex) noexcept;
  bool has_handle(std::int32_t vertex) const noexcept;
  bool determined_without(Index k) noexcept;
  float* handle_columns(std::size_t panel, Index k) noexcept;
  void set_panel_columns(Index k) noexcept;
  void update_columns() noexcept;
  void solve() noexcept;
  detail::FrameFactors factors() const noexcept;

  const HandleModel* model_;
  Index most_;
  Index count_ = 0;
  std::vector<std::int32_t> vertices_;
  Eigen::VectorXd displacements_;  ///< u_K, then room
  Eigen::VectorXd solution_;       ///< a and t, then room
  detail::Capacitance capacitance_;
  detail::Capacitance::Strip columns_, rows_;  ///< of the handle that comes
  Points positions_;                           ///< of the handles that would be left
  Vec3 centre_;                                ///< the packed rest positions are relative to it
  detail::ColumnPanels panels_;                ///< B, X_k of the handles, room
  detail::AlignedVector<float> weights_;
  detail::FrameFactors factors_;
};

}  // namespace skinbem
