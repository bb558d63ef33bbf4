// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/motion/bvh.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>
#include <set>

#include <skinbem/base/text.hpp>

namespace skinbem {
namespace {

constexpr std::pair<std::string_view, BvhChannel> channel_names[] = {
    {"Xposition", BvhChannel::x_position}, {"Yposition", BvhChannel::y_position}, {"Zposition", BvhChannel::z_position},
    {"Xrotation", BvhChannel::x_rotation}, {"Yrotation", BvhChannel::y_rotation}, {"Zrotation", BvhChannel::z_rotation},
};

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : file_(path) {}

  BvhMotion read() {
    expect("HIERARCHY");
    while (peek() == "ROOT") read_tree();
    if (motion_.joints.empty()) fail("expected ROOT, found " + in_quotes(peek()));
    expect("MOTION");
    read_frames();
    return std::move(motion_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { file_.fail(std::min(line_, file_.lines().size()), what); }

  /// The next word, without consuming it; empty at the end of the file.
  std::string_view peek() {
    while (words_.empty() && line_ < file_.lines().size()) {
      words_ = words(file_.lines()[line_++]);
      std::reverse(words_.begin(), words_.end());
    }
    return words_.empty() ? std::string_view() : words_.back();
  }
  std::string_view next() {
    const std::string_view word = peek();
    if (word.empty()) fail("the file ends too early, it is cut off");
    words_.pop_back();
    return word;
  }
  void expect(std::string_view keyword) {
    const std::string_view word = next();
    if (word != keyword) fail("expected " + std::string(keyword) + ", found " + in_quotes(word));
  }
  double number() {
    const std::string_view word = next();
    const std::optional<double> value = parse_number(word);
    if (!value) fail(in_quotes(word) + " is not a finite number");
    return *value;
  }
  Index count(Index most) {
    const std::string_view word = next();
    const std::optional<std::int64_t> value = parse_integer(word);
    if (!value || *value < 0 || *value > most) {
      fail(in_quotes(word) + " is not a count from 0 to " + std::to_string(most));
    }
    return *value;
  }

  void read_tree();
  void open_joint(Index parent, const std::string& name);
  void read_channels(BvhJoint& joint);
  void read_frames();

  const TextFile file_;
  std::size_t line_ = 0;                 // lines consumed so far, so also the number of the line at hand
  std::vector<std::string_view> words_;  // rest of the line at hand, last word first
  std::set<std::string, std::less<>> names_;
  Index channel_count_ = 0;
  BvhMotion motion_;
};

void Reader::read_tree() {
  std::vector<Index> open;  // the joints whose braces are open, the root first
  do {
    const std::string_view word = next();
    const bool in_end_site = !open.empty() && motion_.joints[open.back()].name.ends_with(".end");
    if (word == "}" && !open.empty()) {
      open.pop_back();
    } else if (word == "ROOT" && open.empty()) {
      open_joint(-1, std::string(next()));
      open.push_back(std::ssize(motion_.joints) - 1);
    } else if (word == "JOINT" && !open.empty() && !in_end_site) {
      open_joint(open.back(), std::string(next()));
      open.push_back(std::ssize(motion_.joints) - 1);
    } else if (word == "End" && !open.empty() && !in_end_site) {
      expect("Site");
      open_joint(open.back(), motion_.joints[open.back()].name + ".end");
      open.push_back(std::ssize(motion_.joints) - 1);
    } else if (word == "CHANNELS" && !open.empty() && !in_end_site) {
      read_channels(motion_.joints[open.back()]);
    } else {
      fail(in_quotes(word) + " does not belong here; a joint holds OFFSET, CHANNELS, JOINT, End Site and }");
    }
  } while (!open.empty());
}

void Reader::open_joint(Index parent, const std::string& name) {
  if (!names_.insert(name).second) fail("a second joint is called '" + name + "', names must differ");
  expect("{");
  expect("OFFSET");
  BvhJoint joint;
  joint.name = name;
  joint.parent = parent;
  for (double& coordinate : joint.offset) coordinate = number();
  motion_.joints.push_back(std::move(joint));
}

void Reader::read_channels(BvhJoint& joint) {
  if (!joint.channels.empty()) fail("joint '" + joint.name + "' has its CHANNELS already");
  joint.first_channel = channel_count_;
  for (Index left = count(6); left > 0; --left, ++channel_count_) {
    const std::string_view word = next();
    const auto* const known = std::find_if(std::begin(channel_names), std::end(channel_names),
                                           [&](const auto& channel) { return channel.first == word; });
    if (known == std::end(channel_names)) fail("unknown channel " + in_quotes(word) + ", such as Xrotation is meant");
    if (std::count(joint.channels.begin(), joint.channels.end(), known->second)) {
      fail("channel " + in_quotes(word) + " is given twice");
    }
    joint.channels.push_back(known->second);
  }
}

void Reader::read_frames() {
  expect("Frames:");
  const Index frames = count(10'000'000);
  if (frames == 0) fail("the file has no frame");
  expect("Frame");
  expect("Time:");
  motion_.frame_time = number();
  if (!(motion_.frame_time > 0)) fail("the frame time must be positive");
  if (!words_.empty()) fail("superfluous " + in_quotes(words_.back()) + " after the frame time");

  std::vector<double> values;
  Index read = 0;
  for (; line_ < file_.lines().size(); ++line_) {
    const std::vector<std::string_view> row = words(file_.lines()[line_]);
    if (row.empty()) continue;
    if (++read > frames) file_.fail(line_ + 1, "more frames than the " + std::to_string(frames) + " of the header");
    if (std::ssize(row) != channel_count_) {
      file_.fail(line_ + 1, "frame " + std::to_string(read) + " has " + std::to_string(row.size()) +
                                " values, the hierarchy has " + std::to_string(channel_count_) + " channels");
    }
    for (const std::string_view word : row) {
      const std::optional<double> value = parse_number(word);
      if (!value) file_.fail(line_ + 1, in_quotes(word) + " is not a finite number");
      values.push_back(*value);
    }
  }
  if (read < frames) {
    fail("the file ends after " + std::to_string(read) + " of " + std::to_string(frames) + " frames, it is cut off");
  }
  motion_.values = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      values.data(), frames, channel_count_);
}

}  // namespace

Index BvhMotion::find(const std::string& name) const {
  const auto found = std::find_if(joints.begin(), joints.end(), [&](const BvhJoint& j) { return j.name == name; });
  return found == joints.end() ? -1 : found - joints.begin();
}

BvhMotion read_bvh(const std::filesystem::path& path) { return Reader(path).read(); }

std::vector<RigidMotion> joint_poses(const BvhMotion& motion, Index frame) {
  std::vector<RigidMotion> poses;
  poses.reserve(motion.joints.size());
  for (const BvhJoint& joint : motion.joints) {
    RigidMotion local{Mat3::Identity(), joint.offset};
    for (std::size_t i = 0; i < joint.channels.size(); ++i) {
      const int channel = static_cast<int>(joint.channels[i]);
      const double value = motion.values(frame, joint.first_channel + static_cast<Index>(i));
      if (channel < 3) {
        local.translation(channel) = value;
      } else {
        local.rotation *= Eigen::AngleAxisd(value * std::numbers::pi / 180, Vec3::Unit(channel - 3)).toRotationMatrix();
      }
    }
    poses.push_back(joint.parent < 0 ? local : poses[joint.parent] * local);
  }
  return poses;
}

}  // namespace skinbem
