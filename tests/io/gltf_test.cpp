// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/io/gltf.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include <skinbem/base/atomic_file.hpp>
#include <skinbem/base/error.hpp>
#include <skinbem/mesh/vertex_normals.hpp>

#include "files.hpp"
#include "small_animation.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using nlohmann::json;
using testing_support::small_bones;
using testing_support::small_skin;
using testing_support::TemporaryFolder;

/// Reads a GLB as a viewer does, knowing nothing of the writer.
class Glb {
 public:
  explicit Glb(const std::string& file) {
    EXPECT_EQ(file.substr(0, 4), "glTF");
    EXPECT_EQ(word(file, 4), 2u);
    EXPECT_EQ(word(file, 8), file.size());
    const std::size_t text = word(file, 12);
    EXPECT_EQ(text % 4, 0u);
    EXPECT_EQ(file.substr(16, 4), "JSON");
    document = json::parse(file.substr(20, text));
    binary_ = file.substr(28 + text);
    EXPECT_EQ(word(file, 20 + text), binary_.size());
    EXPECT_EQ(binary_.size() % 4, 0u);
    EXPECT_EQ(document["buffers"][0]["byteLength"], binary_.size());
  }

  /// The floats of an accessor, one element a row; checks that it lies within its view and its stated bounds.
  Eigen::MatrixXd floats(std::size_t index) const {
    const json& accessor = document["accessors"][index];
    const json& view = document["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    const std::string type = accessor["type"];
    const Index columns = type == "SCALAR" ? 1 : type.back() - '0', rows = accessor["count"];
    EXPECT_EQ(accessor["componentType"], 5126);
    EXPECT_EQ(view["byteLength"], 4 * rows * columns);
    const std::size_t offset = view["byteOffset"];
    EXPECT_EQ(offset % 4, 0u);
    EXPECT_LE(offset + static_cast<std::size_t>(4 * rows * columns), binary_.size());
    Eigen::Matrix<float, -1, -1, Eigen::RowMajor> values(rows, columns);
    std::memcpy(values.data(), binary_.data() + offset, static_cast<std::size_t>(4 * values.size()));
    for (Index c = 0; accessor.contains("min") && c < columns; ++c) {
      EXPECT_EQ(accessor["min"][static_cast<std::size_t>(c)].get<float>(), values.col(c).minCoeff());
      EXPECT_EQ(accessor["max"][static_cast<std::size_t>(c)].get<float>(), values.col(c).maxCoeff());
    }
    return values.cast<double>();
  }

  /// Values of the track of `path` at the node called `name`.
  Eigen::MatrixXd track(const std::string& name, const std::string& path) const {
    const json& animation = document["animations"][0];
    for (const json& channel : animation["channels"]) {
      const std::size_t node = channel["target"]["node"];
      if (document["nodes"][node]["name"] == name && channel["target"]["path"] == path) {
        return floats(animation["samplers"][channel["sampler"].get<std::size_t>()]["output"]);
      }
    }
    ADD_FAILURE() << "no track " << path << " of " << name;
    return {};
  }

  json document;

 private:
  static std::uint32_t word(const std::string& file, std::size_t at) {
    std::uint32_t value;
    std::memcpy(&value, file.data() + at, 4);
    return value;
  }
  std::string binary_;
};

Glb written(const TemporaryFolder& folder, const SkinAnimation& skin, const std::vector<MovingBone>& bones,
            const GltfOptions& options = {}) {
  EXPECT_TRUE(write_glb(folder / "a.glb", skin, bones, options).empty());
  return Glb(read_file(folder / "a.glb"));
}

RigidMotion rigid_at(const Glb& glb, const std::string& node, Index f) {
  const Eigen::Vector4d q = glb.track(node, "rotation").row(f);
  return {Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix(), glb.track(node, "translation").row(f)};
}

TEST(Gltf, AViewersFrameIsTheModelsFrame) {
  TemporaryFolder folder;
  const Index frames = 40;
  const SkinAnimation skin = small_skin(frames);
  const Glb glb = written(folder, skin, {});
  const json& primitive = glb.document["meshes"][0]["primitives"][0];
  const Eigen::MatrixXd weights = glb.track("skin", "weights");
  ASSERT_EQ(weights.size(), frames * 6);
  for (Index f = 0; f < frames; ++f) {
    Eigen::MatrixXd vertices = glb.floats(primitive["attributes"]["POSITION"]);
    for (Index k = 0; k < 6; ++k) {
      vertices += weights(6 * f + k) * glb.floats(primitive["targets"][static_cast<std::size_t>(k)]["POSITION"]);
    }
    const RigidMotion body = rigid_at(glb, "skin", f);
    for (Index v = 0; v < vertices.rows(); ++v) vertices.row(v) = body(vertices.row(v).transpose()).transpose();
    const Points expected = skin_vertices(skin, f);
    EXPECT_LT((vertices - expected).cwiseAbs().maxCoeff(), tolerance::float_file * expected.cwiseAbs().maxCoeff());
  }
}

TEST(Gltf, NothingIsWrittenThatIsNotFiniteInFloats) {
  TemporaryFolder folder;
  SkinAnimation skin = small_skin(2);
  skin.body[1].translation *= 1e60;
  EXPECT_THROW(write_glb(folder / "a.glb", skin), Error);
  skin = small_skin(2);
  skin.times[1] = 1e60;
  EXPECT_THROW(write_glb(folder / "a.glb", skin), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Gltf, BonesFollowTheirMotionAndKeysAreContinuous) {
  TemporaryFolder folder;
  const Index frames = 40;
  const std::vector<MovingBone> bones = small_bones(frames);
  const Glb glb = written(folder, small_skin(frames), bones);
  for (const MovingBone& bone : bones) {
    for (Index f = 0; f < frames; ++f) {
      const RigidMotion m = rigid_at(glb, bone.name, f), &expected = bone.motion[static_cast<std::size_t>(f)];
      EXPECT_LT((m.rotation - expected.rotation).cwiseAbs().maxCoeff(), tolerance::float_file);
      EXPECT_LT((m.translation - expected.translation).norm(), tolerance::float_file * expected.translation.norm());
    }
  }
  const Eigen::MatrixXd q = glb.track("talus", "rotation");
  for (Index f = 1; f < frames; ++f) EXPECT_GT(q.row(f).dot(q.row(f - 1)), 0.9);
}

TEST(Gltf, NamesTargetsAndStartsAtTimeZeroInMetresWithYUp) {
  TemporaryFolder folder;
  const SkinAnimation skin = small_skin(3);
  const Glb glb = written(folder, skin, {});
  EXPECT_EQ(glb.document["meshes"][0]["extras"]["targetNames"], skin.target_names);
  const Eigen::MatrixXd keys = glb.floats(glb.document["animations"][0]["samplers"][0]["input"]);
  EXPECT_EQ(keys(0), 0);
  EXPECT_NEAR(keys(2), 0.02, 1e-9);
  const json& root = glb.document["nodes"][glb.document["scenes"][0]["nodes"][0].get<std::size_t>()];
  const auto q = root["rotation"].get<std::vector<double>>();
  const Vec3 up = 0.001 * (Eigen::Quaterniond(q[3], q[0], q[1], q[2]) * Vec3(0, 0, 1000));
  EXPECT_LT((up - Vec3(0, 1, 0)).norm(), tolerance::rounding);
  EXPECT_EQ(root["scale"], json({0.001, 0.001, 0.001}));
}

TEST(Gltf, WarnsAboveTwoHundredTargetsAndCanLeaveOutTheirNormals) {
  TemporaryFolder folder;
  GltfOptions options;
  options.morph_normals = false;
  EXPECT_TRUE(write_glb(folder / "a.glb", small_skin(2, 200), {}, options).empty());
  EXPECT_EQ(write_glb(folder / "a.glb", small_skin(2, 201), {}, options).size(), 1u);
  const Glb glb(read_file(folder / "a.glb"));
  EXPECT_FALSE(glb.document["meshes"][0]["primitives"][0]["targets"][0].contains("NORMAL"));
}

TEST(Gltf, WritesNothingThatIsNotFiniteOrDoesNotFit) {
  TemporaryFolder folder;
  const auto code = [&](const SkinAnimation& skin, const std::vector<MovingBone>& bones) {
    try {
      write_glb(folder / "a.glb", skin, bones);
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode{};
  };
  SkinAnimation skin = small_skin(4);
  skin.weights(2, 1) = std::nan("");
  EXPECT_EQ(code(skin, {}), ErrorCode::numerical);
  std::vector<MovingBone> bones = small_bones(4);
  bones[1].motion[3].translation[0] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(code(small_skin(4), bones), ErrorCode::numerical);
  EXPECT_EQ(code(small_skin(4), small_bones(3)), ErrorCode::usage);
  EXPECT_EQ(code(small_skin(0), {}), ErrorCode::usage);
  skin = small_skin(4);
  skin.times[2] = skin.times[1];
  EXPECT_EQ(code(skin, {}), ErrorCode::usage);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(VertexNormals, TheirChangeIsTheirDerivative) {
  const SkinAnimation skin = small_skin(1);
  const Points direction = Eigen::Map<const Points>(skin.targets.col(0).data(), 6, 3);
  const double h = 1e-3;
  TriangleMesh ahead = skin.rest, behind = skin.rest;
  ahead.vertices += h * direction;
  behind.vertices -= h * direction;
  const Points difference = (vertex_normals(ahead) - vertex_normals(behind)) / (2 * h);
  const Points change = vertex_normal_change(skin.rest, direction);
  EXPECT_LT((difference - change).cwiseAbs().maxCoeff(), tolerance::central_difference * change.cwiseAbs().maxCoeff());
}

}  // namespace
}  // namespace skinbem
