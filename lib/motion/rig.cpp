// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/motion/rig.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <set>

#include <skinbem/base/rigid_fit.hpp>
#include <skinbem/motion/rig_file.hpp>

namespace skinbem {
namespace {

constexpr double least_spread = 0.02;  // collinear_measure below which points count as lying on a line

/// "+x", "-y", ... or "x": a coordinate axis with its sign.
Vec3 axis_named(RigFile& file, const std::string& table, const std::string& key) {
  const std::string name = file.text(table, key);
  const double sign = name[0] == '-' ? -1 : 1;
  const std::size_t letter = name[0] == '-' || name[0] == '+' ? 1 : 0;
  if (name.size() != letter + 1 || name[letter] < 'x' || name[letter] > 'z') {
    file.fail(table, key, "'" + key + "' must be an axis such as \"+z\" or \"-y\", not '" + name + "'");
  }
  return sign * Vec3::Unit(name[letter] - 'x');
}

/// Columns: forward, up, and their cross product.
Mat3 world(RigFile& file, const std::string& table) {
  Mat3 axes;
  axes.col(0) = axis_named(file, table, "forward");
  axes.col(1) = axis_named(file, table, "up");
  axes.col(2) = axes.col(0).cross(axes.col(1));
  if (axes.col(2).isZero()) file.fail(table, "forward", "'up' and 'forward' must be different axes");
  return axes;
}

std::string table_of(const std::string& segment) { return "segments." + segment; }

void read_bvh_frame(RigFile& file, RigSegment& segment) {
  const std::string table = table_of(segment.name);
  segment.proximal = file.point(table, "proximal");
  segment.distal = file.point(table, "distal");
  segment.axis = file.direction(table, "axis");
  segment.proximal_joint = file.text(table, "proximal_joint");
  segment.distal_joint = file.text(table, "distal_joint");
  segment.motion_axis = file.direction(table, "motion_axis");
  const Vec3 along = segment.distal - segment.proximal;
  if (along.cross(segment.axis).norm() <= least_spread * along.norm()) {
    file.fail(table, "axis", "'axis' must not lie along the line from 'proximal' to 'distal', which must differ");
  }
}

RigSegment read_segment(RigFile& file, const std::string& name, MotionFormat format) {
  const std::string table = table_of(name);
  RigSegment segment;
  segment.name = name;
  for (const std::string& bone : file.texts(table, "bones")) segment.bones.push_back(bone_name(bone));
  if (file.has(table, "landmarks")) segment.landmarks = file.texts(table, "landmarks");
  if (format == MotionFormat::bvh) {
    read_bvh_frame(file, segment);
    segment.joint = file.has(table, "joint") ? file.point(table, "joint") : segment.proximal;
  } else {
    segment.joint = file.point(table, "joint");
    segment.markers = file.texts(table, "markers");
    const std::set<std::string> different(segment.markers.begin(), segment.markers.end());
    if (different.size() != segment.markers.size()) file.fail(table, "markers", "a marker is named twice");
    if (different.size() < 3) file.fail(table, "markers", "a rigid fit needs three markers or more");
  }
  return segment;
}

/// Moves the segments into an order in which parents come before their children, and sets the parents' indices.
std::vector<RigSegment> by_descent(RigFile& file, std::vector<RigSegment> segments) {
  std::map<std::string, std::string> parents;
  for (const RigSegment& segment : segments) {
    const std::string table = table_of(segment.name);
    const std::string parent = file.has(table, "parent") ? file.text(table, "parent") : "";
    const auto is_parent = [&](const RigSegment& other) { return other.name == parent; };
    if (!parent.empty() && std::none_of(segments.begin(), segments.end(), is_parent)) {
      file.fail(table, "parent", "the parent '" + parent + "' is no segment of this rig");
    }
    parents[segment.name] = parent;
  }
  std::vector<RigSegment> ordered;
  const auto place = [&](const std::string& name) {
    return std::find_if(ordered.begin(), ordered.end(), [&](const RigSegment& s) { return s.name == name; });
  };
  while (!segments.empty()) {
    const auto ready = std::find_if(segments.begin(), segments.end(), [&](const RigSegment& s) {
      return parents[s.name].empty() ? ordered.empty() : place(parents[s.name]) != ordered.end();
    });
    if (ready == segments.end()) {
      file.fail(table_of(segments[0].name), "parent",
                "exactly one segment, the root, has no 'parent', and the others descend from it");
    }
    const auto parent = place(parents[ready->name]);
    ready->parent = parent == ordered.end() ? -1 : parent - ordered.begin();
    ordered.push_back(std::move(*ready));
    segments.erase(ready);
  }
  return ordered;
}

/// No bone and no landmark may follow two segments.
void check_membership(const RigFile& file, const std::vector<RigSegment>& segments) {
  std::set<std::string> bones, landmarks;
  for (const RigSegment& segment : segments) {
    for (const std::string& bone : segment.bones) {
      if (!bones.insert(bone).second) file.fail(table_of(segment.name), "bones", "bone '" + bone + "' is named twice");
    }
    for (const std::string& landmark : segment.landmarks) {
      if (landmarks.insert(landmark).second) continue;
      file.fail(table_of(segment.name), "landmarks", "landmark '" + landmark + "' is named twice");
    }
  }
}

std::vector<Placement> read_placement(RigFile& file) {
  std::vector<Placement> result;
  for (const std::string& name : file.tables_in("placement")) {
    const std::string table = "placement." + name;
    Placement placement;
    if (file.has(table, "marker") == file.has(table, "laboratory")) {
      file.fail(table, "", "[" + table + "] needs either 'marker' or 'laboratory'");
    }
    if (file.has(table, "marker")) {
      placement.laboratory = file.text(table, "marker");
    } else {
      placement.laboratory = file.point(table, "laboratory");
    }
    placement.mesh = file.point(table, "mesh");
    result.push_back(std::move(placement));
  }
  Points points(std::ssize(result), 3);
  for (Index i = 0; i < points.rows(); ++i) points.row(i) = result[static_cast<std::size_t>(i)].mesh.transpose();
  if (points.rows() < 3 || collinear_measure(points) < least_spread) {
    file.fail("", "", "placing the mesh in the laboratory needs three tables [placement.NAME] or more, not on a line");
  }
  return result;
}

void read_scale(RigFile& file, Rig& rig) {
  rig.scale_segment = rig.segments[0].name;
  if (!file.has("motion", "scale")) return;
  const std::string text = file.text("motion", "scale");
  if ((rig.scale = parse_number(text))) {
    if (!(*rig.scale > 0)) file.fail("motion", "scale", "'scale' must be positive");
    return;
  }
  rig.scale_segment = text;
  const auto named = [&](const RigSegment& segment) { return segment.name == text; };
  if (std::none_of(rig.segments.begin(), rig.segments.end(), named)) {
    file.fail("motion", "scale", "'scale' must be a number or the name of a segment, not '" + text + "'");
  }
}

void read_marker_motion(RigFile& file, Rig& rig) {
  rig.rest_time = file.number("motion", "rest_time");
  const std::string joints = file.has("motion", "joints") ? file.text("motion", "joints") : "chained";
  if (joints != "chained" && joints != "free")
    file.fail("motion", "joints", "'joints' must be \"chained\" or \"free\"");
  rig.chained = joints == "chained";
  rig.placement = read_placement(file);
  for (const std::string& landmark : file.keys_of("skin_markers")) {
    rig.skin_markers[landmark] = file.text("skin_markers", landmark);
  }
}

}  // namespace

std::string bone_name(const std::string& bone) { return std::filesystem::path(bone).stem().string(); }

Index Rig::segment_of_bone(const std::string& bone) const {
  const std::string name = bone_name(bone);
  const auto found = std::find_if(segments.begin(), segments.end(), [&](const RigSegment& segment) {
    return std::count(segment.bones.begin(), segment.bones.end(), name) > 0;
  });
  return found == segments.end() ? -1 : found - segments.begin();
}

Rig read_rig(const std::filesystem::path& path) {
  RigFile file(path);
  Rig rig;
  rig.path = path.string();
  const std::string format = file.text("motion", "format");
  if (format != "bvh" && format != "trc") file.fail("motion", "format", "'format' must be \"bvh\" or \"trc\"");
  rig.format = format == "bvh" ? MotionFormat::bvh : MotionFormat::trc;

  const Mat3 mesh_world = world(file, "mesh");
  rig.axes = mesh_world * world(file, "motion").transpose();
  rig.mesh_up = mesh_world.col(1);
  rig.mesh_floor = file.number("mesh", "floor");
  rig.motion_floor = file.has("motion", "floor") ? file.number("motion", "floor") : 0;

  std::vector<RigSegment> segments;
  for (const std::string& name : file.tables_in("segments")) segments.push_back(read_segment(file, name, rig.format));
  if (segments.empty()) file.fail("", "", "names no segment, add a table [segments.NAME] for each rigid part");
  rig.segments = by_descent(file, std::move(segments));
  check_membership(file, rig.segments);
  if (rig.format == MotionFormat::bvh) {
    read_scale(file, rig);
  } else {
    read_marker_motion(file, rig);
  }
  file.refuse_the_rest();
  return rig;
}

}  // namespace skinbem
