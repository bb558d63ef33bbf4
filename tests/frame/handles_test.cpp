// SPDX-License-Identifier: BSD-3-Clause
// Handles that come, go and are pulled give what a response matrix of the same landmarks gives.
#include <skinbem/frame/handles.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include <Eigen/Geometry>

#include <skinbem/base/error.hpp>

#include "response/bodies.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;
using Places = std::vector<std::int32_t>;

Points positions_of(const Handles& handles, Index vertices) {
  std::vector<float> positions(static_cast<std::size_t>(3 * vertices));
  EXPECT_TRUE(handles.evaluate(VertexTarget{positions}));
  return Eigen::Map<const Eigen::VectorXf>(positions.data(), 3 * vertices)
      .cast<double>()
      .reshaped<Eigen::RowMajor>(vertices, 3);
}

Points displacements_of(const Handles& handles) {
  Points u(handles.count(), 3);
  for (Index k = 0; k < u.rows(); ++k) u.row(k) = handles.displacement(k).transpose();
  return u;
}

/// A body of 56 vertices, or a round one of 162, with point handles or wide ones.
class HandlesOn : public ::testing::TestWithParam<std::pair<bool, double>> {
 protected:
  TriangleMesh mesh_ = GetParam().first ? slender_ellipsoid(2) : cube(3);
  double radius_ = GetParam().second;
  ResponseModel body_{mesh_, {0.45, 1e-10, {}}};
  HandleModel model_{body_, radius_};

  /// X + R u for landmarks where the handles are.
  Points expected(const Handles& handles) {
    Places places;
    for (Index k = 0; k < handles.count(); ++k) places.push_back(handles.vertex(k));
    while (!body_.landmarks().empty()) body_.remove(0);
    body_.add(landmarks_on(places, radius_));
    const Points u = displacements_of(handles);
    const Eigen::VectorXd moved = body_.response() * Eigen::Map<const Eigen::VectorXd>(u.data(), u.size());
    return mesh_.vertices + Eigen::Map<const Points>(moved.data(), moved.size() / 3, 3);
  }
  void expect_as_response(const Handles& handles) {
    EXPECT_LE((positions_of(handles, mesh_.vertex_count()) - expected(handles)).cwiseAbs().maxCoeff(),
              tolerance::handles * mesh_.vertices.cwiseAbs().maxCoeff());
  }
};

INSTANTIATE_TEST_SUITE_P(Bodies, HandlesOn,
                         ::testing::Values(std::pair{false, 0.0}, std::pair{false, 0.5}, std::pair{true, 0.0},
                                           std::pair{true, 1.0}));

TEST_P(HandlesOn, AtRestLeaveTheSkinAtRest) {
  const Handles handles(model_, Places{0, 9, 30});
  EXPECT_LE((positions_of(handles, mesh_.vertex_count()) - mesh_.vertices).cwiseAbs().maxCoeff(),
            tolerance::frame_rigid * 10);
}

TEST_P(HandlesOn, PulledMoveTheSkinAsTheResponseMatrixDoes) {
  Handles handles(model_, Places{0, 9, 30, 50});
  ASSERT_TRUE(handles.pull(0.2 * Points::Random(4, 3)));
  expect_as_response(handles);
  ASSERT_TRUE(handles.pull(2, Vec3(0.1, -0.3, 0.2)));
  EXPECT_EQ(handles.displacement(2), Vec3(0.1, -0.3, 0.2));
  expect_as_response(handles);
}

TEST_P(HandlesOn, GrabLeavesTheSkinAsItIsUntilPulled) {
  Handles handles(model_, Places{0, 9, 30});
  ASSERT_TRUE(handles.pull(0.2 * Points::Random(3, 3)));
  const Points before = positions_of(handles, mesh_.vertex_count());
  ASSERT_TRUE(handles.grab(20));
  EXPECT_EQ(handles.vertex(3), 20);
  EXPECT_LE((positions_of(handles, mesh_.vertex_count()) - before).cwiseAbs().maxCoeff(),
            tolerance::handles * mesh_.vertices.cwiseAbs().maxCoeff());
  ASSERT_TRUE(handles.pull(3, handles.displacement(3) + Vec3(0, 0, 0.2)));
  expect_as_response(handles);
}

TEST_P(HandlesOn, ReleasedFollowTheHandlesThatAreLeft) {
  Handles handles(model_, Places{0, 9, 30, 50, 20});
  ASSERT_TRUE(handles.pull(0.2 * Points::Random(5, 3)));
  const Points u = displacements_of(handles);
  ASSERT_TRUE(handles.release(1));
  ASSERT_EQ(handles.count(), 4);
  EXPECT_EQ(handles.vertex(1), 30);
  EXPECT_EQ(displacements_of(handles).bottomRows(3), u.bottomRows(3));
  expect_as_response(handles);
}

TEST_P(HandlesOn, MovedKeepTheirNumber) {
  Handles handles(model_, Places{0, 9, 30, 50}, 4);  // no room but for the moved one
  ASSERT_TRUE(handles.pull(0.2 * Points::Random(4, 3)));
  ASSERT_TRUE(handles.move(1, 12));
  ASSERT_EQ(handles.count(), 4);
  EXPECT_EQ(handles.vertex(0), 0);
  EXPECT_EQ(handles.vertex(1), 12);
  EXPECT_EQ(handles.vertex(3), 50);
  expect_as_response(handles);
  ASSERT_TRUE(handles.pull(1, Vec3(0.3, 0, 0.1)));
  expect_as_response(handles);
}

TEST_P(HandlesOn, ThousandsOfEditsLeaveNoTrace) {
  Handles handles(model_, Places{0, 9, 30}, 12);
  std::mt19937 random(1);
  const auto below = [&](Index n) { return static_cast<std::int32_t>(random() % static_cast<unsigned>(n)); };
  int done = 0;
  for (int i = 0; i < 3000; ++i) {
    const std::int32_t vertex = below(mesh_.vertex_count());
    const Index k = below(handles.count());
    switch (below(4)) {
      case 0:
        done += handles.grab(vertex);
        break;
      case 1:
        done += handles.release(k);
        break;
      case 2:
        done += handles.move(k, vertex);
        break;
      default:
        done += handles.pull(k, 0.2 * Vec3::Random());
    }
  }
  EXPECT_GE(done, 1500);
  ASSERT_TRUE(handles.pull(0.2 * Points::Random(handles.count(), 3)));
  expect_as_response(handles);
}

TEST_P(HandlesOn, MoveWithTheBody) {
  Handles handles(model_, Places{0, 9, 30});
  ASSERT_TRUE(handles.pull(0, Vec3(0.1, 0.2, 0)));
  const Points before = positions_of(handles, mesh_.vertex_count());
  const RigidMotion motion{Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix(), {3, -1, 2}};
  ASSERT_TRUE(handles.set_body_motion(motion));
  const Points turned = (before * motion.rotation.transpose()).rowwise() + motion.translation.transpose();
  EXPECT_LE((positions_of(handles, mesh_.vertex_count()) - turned).cwiseAbs().maxCoeff(), tolerance::frame_rigid * 20);
}

class RefusedHandles : public ::testing::Test {
 protected:
  TriangleMesh mesh_ = cube(2);
  ResponseModel body_{mesh_, {0.45, 1e-6, {}}};
  HandleModel model_{body_};

  std::int32_t on(const Vec3& x) const { return vertex_at(mesh_, x); }
  Places corners() const { return {on({0, 0, 0}), on({1, 0, 0}), on({0, 1, 0})}; }
  ErrorCode code_of(const Places& places, Index most = 8) const {
    try {
      const Handles handles(model_, places, most);
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode{};
  }
};

TEST_F(RefusedHandles, ThatDoNotDetermineTheBody) {
  EXPECT_EQ(code_of({}), ErrorCode::bad_input);
  EXPECT_EQ(code_of({0, 5}), ErrorCode::bad_input);
  EXPECT_EQ(code_of({on({0, 0, 0}), on({0.5, 0, 0}), on({1, 0, 0})}), ErrorCode::bad_input);
  EXPECT_EQ(code_of(corners()), ErrorCode{});
}

TEST_F(RefusedHandles, ThatAreNotOnTheSkinOrTwiceOrTooMany) {
  EXPECT_EQ(code_of({0, 5, 26}), ErrorCode::usage);
  EXPECT_EQ(code_of({-1, 5, 3}), ErrorCode::usage);
  EXPECT_EQ(code_of({0, 5, 5, 7}), ErrorCode::usage);
  EXPECT_EQ(code_of({0, 1, 2, 3}, 3), ErrorCode::usage);
}

TEST_F(RefusedHandles, EditsThatCannotBeChangeNothing) {
  Handles handles(model_, corners(), 4);
  const std::int32_t on_edge = on({0.5, 0, 0});
  ASSERT_TRUE(handles.pull(0, Vec3(0.1, 0, 0)));
  ASSERT_TRUE(handles.grab(on_edge));
  const Points before = positions_of(handles, mesh_.vertex_count());
  constexpr double infinity = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(handles.grab(on({0, 0, 1}))) << "no room";
  EXPECT_FALSE(handles.move(0, on_edge)) << "taken";
  EXPECT_FALSE(handles.move(0, 26)) << "no such vertex";
  EXPECT_FALSE(handles.move(4, on({0, 0, 1}))) << "no such handle";
  EXPECT_FALSE(handles.move(2, on({0.5, 0, 0}))) << "all on a line";
  EXPECT_FALSE(handles.release(2)) << "all on a line";
  EXPECT_FALSE(handles.release(-1));
  for (const double bad : {infinity, -infinity, std::numeric_limits<double>::quiet_NaN(), 1e13}) {
    EXPECT_FALSE(handles.pull(0, Vec3(0, bad, 0)));
    EXPECT_FALSE(handles.pull(Points::Constant(4, 3, bad)));
    EXPECT_FALSE(handles.set_body_motion({Mat3::Identity(), Vec3(0, 0, bad * bad * bad)}));
    EXPECT_FALSE(handles.set_body_motion({Mat3::Constant(bad), Vec3::Zero()}));
  }
  EXPECT_FALSE(handles.pull(Points::Zero(3, 3)));
  EXPECT_EQ(positions_of(handles, mesh_.vertex_count()), before);
  ASSERT_TRUE(handles.release(3));
  EXPECT_FALSE(handles.release(0)) << "fewer than three";
  std::vector<float> small(static_cast<std::size_t>(3 * mesh_.vertex_count()) - 1, -1.0F);
  EXPECT_FALSE(handles.evaluate(VertexTarget{small}));
  EXPECT_EQ(small, std::vector<float>(small.size(), -1.0F));
}

TEST_F(RefusedHandles, TheLargestPullStaysFinite) {
  Handles handles(model_, corners());
  ASSERT_TRUE(handles.pull(1e12 * Points::Random(3, 3)));
  EXPECT_TRUE(positions_of(handles, mesh_.vertex_count()).allFinite());
}

TEST_F(RefusedHandles, ARadiusThatIsNone) {
  EXPECT_THROW(HandleModel(body_, -1), Error);
  EXPECT_THROW(HandleModel(body_, std::nan("")), Error);
}

TEST_F(RefusedHandles, CopiesAreCharactersOfTheirOwn) {
  Handles first(model_, corners());
  const Handles second = first;
  ASSERT_TRUE(first.pull(0, Vec3(0.1, 0, 0)));
  EXPECT_EQ(second.displacement(0), Vec3(0, 0, 0));
  EXPECT_LE((positions_of(second, mesh_.vertex_count()) - mesh_.vertices).cwiseAbs().maxCoeff(),
            tolerance::frame_rigid * 10);
}

}  // namespace
}  // namespace skinbem
