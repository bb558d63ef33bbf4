// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/io/gltf.hpp>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include <skinbem/base/atomic_file.hpp>
#include <skinbem/base/error.hpp>
#include <skinbem/mesh/vertex_normals.hpp>

namespace skinbem {
namespace {

using nlohmann::json;

// Numbers of the glTF 2.0 specification.
constexpr int component_float = 5126, component_uint16 = 5123, component_uint32 = 5125;
constexpr int target_vertices = 34962, target_indices = 34963;
constexpr std::uint32_t glb_magic = 0x46546C67, glb_version = 2, chunk_json = 0x4E4F534A, chunk_bin = 0x004E4942;

using RowsF = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The document and its binary chunk while they grow.
class GlbBuilder {
 public:
  json document = {{"asset", {{"version", "2.0"}, {"generator", "skinbem"}}}};

  /// Adds rows of floats as one accessor of `type` and returns its index; `bounds` adds min and max, computed from the
  /// floats that are stored, as the validator compares them exactly.
  std::size_t add(const RowsF& rows, const char* type, bool bounds, int target = 0) {
    require_finite(rows.allFinite(), "a number in single precision");
    const std::size_t count = std::strcmp(type, "SCALAR") == 0 ? rows.size() : rows.rows();
    json accessor = {{"bufferView", view(rows.data(), sizeof(float) * rows.size(), target)},
                     {"componentType", component_float},
                     {"count", count},
                     {"type", type}};
    if (bounds) {
      accessor["min"] = numbers(rows.colwise().minCoeff());
      accessor["max"] = numbers(rows.colwise().maxCoeff());
    }
    return append("accessors", std::move(accessor));
  }

  std::size_t add_indices(const Triangles& triangles, Index vertices) {
    // 65535 itself is the restart index of 16 bits.
    const bool narrow = vertices < std::numeric_limits<std::uint16_t>::max();
    std::size_t at = 0;
    if (narrow) {
      const Eigen::Matrix<std::uint16_t, Eigen::Dynamic, 3, Eigen::RowMajor> indices = triangles.cast<std::uint16_t>();
      at = view(indices.data(), sizeof(std::uint16_t) * indices.size(), target_indices);
    } else {
      at = view(triangles.data(), sizeof(std::int32_t) * triangles.size(), target_indices);
    }
    return append("accessors", {{"bufferView", at},
                                {"componentType", narrow ? component_uint16 : component_uint32},
                                {"count", triangles.size()},
                                {"type", "SCALAR"}});
  }

  /// Appends `value` to the top-level array `list` and returns its index.
  std::size_t append(const char* list, json value) {
    document[list].push_back(std::move(value));
    return document[list].size() - 1;
  }

  void write(const std::filesystem::path& path) {
    align(binary_, '\0');
    document["buffers"] = json::array({{{"byteLength", binary_.size()}}});
    std::string text = document.dump(-1, ' ', false, json::error_handler_t::replace);
    align(text, ' ');
    const std::size_t total = 12 + 8 + text.size() + 8 + binary_.size();
    if (total > std::numeric_limits<std::uint32_t>::max()) {
      throw Error(ErrorCode::usage, path.string() + ": a GLB file ends at 4 GiB, write fewer frames or targets");
    }
    write_file_atomically(path, [&](std::ostream& out) {
      for (std::uint32_t word : {glb_magic, glb_version, static_cast<std::uint32_t>(total)}) put(out, word);
      chunk(out, chunk_json, text);
      chunk(out, chunk_bin, binary_);
    });
  }

 private:
  std::size_t view(const void* data, std::size_t bytes, int target) {
    align(binary_, '\0');
    json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes}};
    if (target) view["target"] = target;
    binary_.append(static_cast<const char*>(data), bytes);
    return append("bufferViews", std::move(view));
  }
  static json numbers(const Eigen::RowVectorXf& row) { return std::vector<float>(row.begin(), row.end()); }
  static void align(std::string& bytes, char filler) { bytes.append((4 - bytes.size() % 4) % 4, filler); }
  static void put(std::ostream& out, std::uint32_t word) { out.write(reinterpret_cast<const char*>(&word), 4); }
  static void chunk(std::ostream& out, std::uint32_t type, const std::string& bytes) {
    put(out, static_cast<std::uint32_t>(bytes.size()));
    put(out, type);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }

  std::string binary_;
};

std::size_t add_material(GlbBuilder& glb, const char* name, const std::array<double, 3>& colour, double opacity,
                         double roughness) {
  json material = {{"name", name},
                   {"pbrMetallicRoughness",
                    {{"baseColorFactor", {colour[0], colour[1], colour[2], opacity}},
                     {"metallicFactor", 0.0},
                     {"roughnessFactor", roughness}}}};
  if (opacity < 1) material["alphaMode"] = "BLEND";
  return glb.append("materials", std::move(material));
}

/// The mesh at rest as a primitive, without morph targets.
json rest_primitive(GlbBuilder& glb, const TriangleMesh& mesh, std::size_t material) {
  return {{"attributes",
           {{"POSITION", glb.add(mesh.vertices.cast<float>(), "VEC3", true, target_vertices)},
            {"NORMAL", glb.add(vertex_normals(mesh).cast<float>(), "VEC3", false, target_vertices)}}},
          {"indices", glb.add_indices(mesh.triangles, mesh.vertex_count())},
          {"material", material}};
}

std::size_t add_skin_mesh(GlbBuilder& glb, const SkinAnimation& skin, std::size_t material, bool morph_normals) {
  json primitive = rest_primitive(glb, skin.rest, material);
  for (Index k = 0; k < skin.targets.cols(); ++k) {
    const Points shift = Eigen::Map<const Points>(skin.targets.col(k).data(), skin.rest.vertex_count(), 3);
    json target = {{"POSITION", glb.add(shift.cast<float>(), "VEC3", true, target_vertices)}};
    if (morph_normals) {
      target["NORMAL"] = glb.add(vertex_normal_change(skin.rest, shift).cast<float>(), "VEC3", false, target_vertices);
    }
    primitive["targets"].push_back(std::move(target));
  }
  json mesh = {{"name", "skin"}, {"primitives", json::array({std::move(primitive)})}};
  if (skin.targets.cols() > 0) {
    mesh["weights"] = std::vector<double>(skin.target_names.size(), 0.0);
    mesh["extras"] = {{"targetNames", skin.target_names}};
  }
  return glb.append("meshes", std::move(mesh));
}

/// The tracks of one animation that share their key times.
class Tracks {
 public:
  Tracks(GlbBuilder& glb, const std::vector<double>& times) : glb_(glb) {
    RowsF keys(static_cast<Index>(times.size()), 1);
    for (Index f = 0; f < keys.rows(); ++f) {
      keys(f) = static_cast<float>(times[static_cast<std::size_t>(f)] - times.front());
      if (f > 0 && !(keys(f) > keys(f - 1))) {
        throw Error(ErrorCode::usage, "animation: two frames fall on one time in float32, ask for fewer a second");
      }
    }
    keys_ = glb.add(keys, "SCALAR", true);
  }

  void rigid(std::size_t node, const std::vector<RigidMotion>& motion) {
    RowsF translation(static_cast<Index>(motion.size()), 3), rotation(static_cast<Index>(motion.size()), 4);
    Eigen::Quaterniond last = Eigen::Quaterniond::Identity();
    for (Index f = 0; f < translation.rows(); ++f) {
      const RigidMotion& m = motion[static_cast<std::size_t>(f)];
      Eigen::Quaterniond q = Eigen::Quaterniond(m.rotation).normalized();
      // q and -q are one rotation: the one near the last key keeps the interpolation on the short way.
      if (q.dot(last) < 0) q.coeffs() *= -1;
      last = q;
      translation.row(f) = m.translation.cast<float>();
      rotation.row(f) = q.coeffs().cast<float>();  // x, y, z, w, glTF's order too
    }
    track(node, "translation", glb_.add(translation, "VEC3", false));
    track(node, "rotation", glb_.add(rotation, "VEC4", false));
  }

  void weights(std::size_t node, const Eigen::MatrixXd& weights) {
    if (weights.cols() > 0) track(node, "weights", glb_.add(weights.cast<float>(), "SCALAR", false));
  }

  json finish() { return {{"name", "motion"}, {"samplers", std::move(samplers_)}, {"channels", std::move(channels_)}}; }

 private:
  void track(std::size_t node, const char* path, std::size_t values) {
    samplers_.push_back({{"input", keys_}, {"output", values}, {"interpolation", "LINEAR"}});
    channels_.push_back({{"sampler", samplers_.size() - 1}, {"target", {{"node", node}, {"path", path}}}});
  }

  GlbBuilder& glb_;
  std::size_t keys_ = 0;
  json samplers_ = json::array(), channels_ = json::array();
};

}  // namespace

std::vector<std::string> write_glb(const std::filesystem::path& path, const SkinAnimation& skin,
                                   const std::vector<MovingBone>& bones, const GltfOptions& options) {
  validate(skin, bones);
  if (!(options.metres_per_unit > 0) || !(options.skin_opacity > 0 && options.skin_opacity <= 1)) {
    throw Error(ErrorCode::usage, "glTF options: metres_per_unit must be positive and skin_opacity in (0, 1]");
  }
  GlbBuilder glb;
  const std::size_t skin_material = add_material(glb, "skin", options.skin_colour, options.skin_opacity, 0.6);
  Tracks tracks(glb, skin.times);

  const std::size_t skin_mesh = add_skin_mesh(glb, skin, skin_material, options.morph_normals);
  const std::size_t skin_node = glb.append("nodes", {{"name", "skin"}, {"mesh", skin_mesh}});
  tracks.rigid(skin_node, skin.body);
  tracks.weights(skin_node, skin.weights);
  std::vector<std::size_t> children{skin_node};

  const std::size_t bone_material = bones.empty() ? 0 : add_material(glb, "bone", options.bone_colour, 1, 0.75);
  for (const MovingBone& bone : bones) {
    json primitive = rest_primitive(glb, bone.mesh, bone_material);
    const std::size_t mesh =
        glb.append("meshes", {{"name", bone.name}, {"primitives", json::array({std::move(primitive)})}});
    children.push_back(glb.append("nodes", {{"name", bone.name}, {"mesh", mesh}}));
    tracks.rigid(children.back(), bone.motion);
  }

  const double s = options.metres_per_unit;
  json root = {{"name", "model"}, {"children", children}, {"scale", {s, s, s}}};
  // A quarter turn about x takes z up to y up.
  if (options.z_up) root["rotation"] = {-std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)};
  const std::size_t root_node = glb.append("nodes", std::move(root));
  glb.document["scenes"] = json::array({{{"name", "scene"}, {"nodes", {root_node}}}});
  glb.document["scene"] = 0;
  glb.document["animations"] = json::array({tracks.finish()});
  glb.write(path);

  std::vector<std::string> warnings;
  if (skin.targets.cols() > gltf_target_limit) {
    warnings.push_back(path.string() + ": " + std::to_string(skin.targets.cols()) +
                       " morph targets, many viewers show at most " + std::to_string(gltf_target_limit));
  }
  return warnings;
}

}  // namespace skinbem
