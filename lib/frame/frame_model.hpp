// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Real time: a skin that follows its landmarks, one call a frame.
///
///     const FrameModel model(mesh.vertices, response, landmark_rest);    // offline, once; throws Error
///     FrameState state(model);                                           // one for each character
///     std::vector<float> positions(3 * model.vertex_count());
///     while (running) {
///       if (!state.set_landmarks(displacements)) warn();                 // not finite: refused, the last pose stays
///       state.evaluate(positions);                                       // noexcept, no allocation
///     }
#pragma once

#include <span>
#include <string>
#include <vector>

#include <skinbem/base/types.hpp>
#include <skinbem/frame/body_motion.hpp>
#include <skinbem/frame/frame_threads.hpp>
#include <skinbem/frame/packing.hpp>
#include <skinbem/frame/panel_product.hpp>
#include <skinbem/frame/vertex_buffer.hpp>

namespace skinbem {

/// How R is kept.
enum class FrameStorage {
  float32,  ///< 72 bytes a row for six landmarks
  int16,    ///< half of it: a scale for every column of every 32 vertices, finer where the error bound asks for it
  /// For many landmarks on a fine skin: the few directions in which each patch of 128 vertices moves, in int16. Seconds
  /// to make for 10,000 vertices and 100 landmarks.
  compressed,
};

struct FrameOptions {
  FrameMode mode = FrameMode::corotated;
  FrameStorage storage = FrameStorage::float32;
  /// Largest error of a vertex's displacement that the storage may cause, unit of the mesh.
  double error_bound = 1e-3;
  /// The error bound holds while every landmark's q_k is at most this long, unit of the mesh; beyond, the error grows
  /// in proportion.
  double motion_range = 10;

  /// The rest positions are directions, such as normals: a frame turns them and does not shift them.
  bool directions = false;

  FrameOptions() = default;
  FrameOptions(FrameMode m) : mode(m) {}  // NOLINT: the mode alone is what most callers choose
  FrameOptions(FrameMode m, FrameStorage s) : mode(m), storage(s) {}
  /// Throws Error(usage) where a length is not positive.
  void validate() const;
};

class FrameState;

/// Rest positions and response matrix of a skin, packed for frames in single precision. Immutable: any number of states
/// and threads share one.
class FrameModel {
 public:
  /// `rest`: X, #V by 3. `response`: R, 3 #V by 3 #K, rows node-major, columns landmark-major, x, y, z.
  /// `landmark_rest`: p_k = m_k(X), #K by 3. Lengths in the unit of the mesh. Copies what it needs. Throws Error(usage)
  /// on shapes that do not fit and Error(bad_input) on numbers that are not finite or beyond float.
  FrameModel(const Points& rest, const Eigen::MatrixXd& response, const Points& landmark_rest,
             const FrameOptions& options = {});

  Index vertex_count() const noexcept { return static_cast<Index>(packed_.vertices); }
  Index landmark_count() const noexcept { return landmark_rest_.rows(); }
  FrameMode mode() const noexcept { return options_.mode; }
  const Points& landmark_rest() const noexcept { return landmark_rest_; }
  /// What a user should know, in sentences: landmarks so near to a line that they leave a rotation of the body open.
  const std::vector<std::string>& warnings() const noexcept { return warnings_; }
  /// Bytes that a frame reads: R and the rest positions.
  std::size_t bytes() const noexcept { return packed_.data.size() + coordinates_.data.size(); }
  /// No vertex is displaced wrongly by more than this on account of the storage, unit of the mesh, while no q_k is
  /// longer than options.motion_range: at most options.error_bound, 0 for float32. The rounding of the frame's own
  /// arithmetic, in float and of integer weights to 2^-21 of the largest, comes on top (docs/frame.md).
  double achieved_error_bound() const noexcept { return packed_.error_factor * options_.motion_range; }

 private:
  friend class FrameState;
  friend class PartialFrame;
  friend bool evaluate_batch(std::span<const FrameState> frames, std::span<float> positions) noexcept;

  detail::PanelMatrix matrix() const noexcept { return packed_.matrix(); }
  bool compressed() const noexcept { return !order_.empty(); }
  /// Where frames go, in the order in which the vertices are packed.
  detail::FrameTarget target(float* data, std::size_t stride) const noexcept {
    return {data, stride, compressed() ? order_.data() : nullptr};
  }
  /// How many weights the packed columns have.
  std::size_t weight_count() const noexcept;
  /// Makes them: q itself, or z = Z q and q where R is compressed. Returns their limit.
  float packed_weights(const float* q, float* weights) const noexcept;
  const Vec3& packing_centre() const noexcept { return centre_; }
  /// All vertices of `count` frames, on the calling thread.
  void product(const detail::FrameFactors* frames, const detail::FrameTarget* targets,
               std::size_t count) const noexcept;

  Points landmark_rest_;
  FrameOptions options_;
  Vec3 centre_;            ///< the packed rest positions are relative to it: floats are finest about zero
  double largest_weight_;  ///< weights up to here cannot overflow a float on their way
  detail::PackedPanels packed_;
  detail::PackedPanels coordinates_;  ///< where R is compressed: CompressedPanels
  std::vector<std::uint32_t> order_;
  std::vector<std::string> warnings_;
};

/// The pose of one character; refers to its model, which must outlive it. Setting and evaluating neither allocate nor
/// lock nor throw. Distinct states may be used from distinct threads at once.
class FrameState {
 public:
  /// At rest.
  explicit FrameState(const FrameModel& model);

  /// Displacements u_k of the landmarks, #K by 3, mesh frame. Returns false, and keeps the pose as it was, where the
  /// shape is wrong or a number is not finite or so large (about 1e37 / |R|) that a float would overflow.
  bool set_landmarks(const Eigen::Ref<const Points>& displacements) noexcept;

  /// The pose of another state, of a model with as many landmarks: normals beside positions need one fit. Returns
  /// false, and keeps the pose as it was, under the conditions of set_landmarks.
  bool set_motion(const BodyMotion& motion) noexcept;

  /// Writes the positions of all vertices, x, y, z adjacent, mesh frame: always finite. The same bits at every call and
  /// on any number of threads, on one instruction set. Returns false and writes nothing unless positions.size() is 3
  /// #V.
  bool evaluate(std::span<float> positions) const noexcept;
  /// The same into an attribute of an interleaved buffer. Returns false and writes nothing unless it holds #V vertices.
  bool evaluate(const VertexTarget& positions) const noexcept;
  /// The same with the help of other threads where the skin is large enough to gain by it; the same bits.
  bool evaluate(const VertexTarget& positions, FrameThreads& threads) const noexcept;

  /// (Q, t) and q of the present pose: the node's track and the morph weights of a glTF animation.
  const BodyMotion& motion() const noexcept { return motion_; }
  const FrameModel& model() const noexcept { return *model_; }

 private:
  friend bool evaluate_batch(std::span<const FrameState> frames, std::span<float> positions) noexcept;

  bool accept_candidate() noexcept;
  void repeat_rigid() noexcept;
  detail::FrameFactors factors() const noexcept;

  const FrameModel* model_;
  BodyMotion motion_;
  BodyMotion candidate_;
  detail::AlignedVector<float> q_;        ///< in single precision
  detail::AlignedVector<float> weights_;  ///< of the packed columns
  detail::FrameFactors factors_;          ///< of motion_; but for the weights themselves
};

/// Many frames, or many characters, of one model as a matrix product: R is read once for all of them. Frame f goes to
/// positions[3 #V f ...], the same bits as frames[f].evaluate(). Returns false and writes nothing where the frames
/// belong to different models or positions.size() is not 3 #V times their number.
bool evaluate_batch(std::span<const FrameState> frames, std::span<float> positions) noexcept;

}  // namespace skinbem
