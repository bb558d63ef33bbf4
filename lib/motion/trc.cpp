// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/motion/trc.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <skinbem/base/text.hpp>

namespace skinbem {
namespace {

constexpr double not_seen = std::numeric_limits<double>::quiet_NaN();

/// The fields of a line; tabs at its end carry nothing.
std::vector<std::string_view> fields(std::string_view line) {
  std::vector<std::string_view> result = split(line, '\t');
  for (std::string_view& field : result) field = trimmed(field);
  return result;
}

void drop_empty_tail(std::vector<std::string_view>& fields, std::size_t least) {
  while (fields.size() > least && fields.back().empty()) fields.pop_back();
}

bool means_not_seen(std::string_view cell) { return cell.empty() || cell == "NaN" || cell == "nan" || cell == "NAN"; }

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : file_(path) {}

  TrcMotion read() {
    if (file_.lines().size() < 5 || !file_.lines()[0].starts_with("PathFileType")) {
      file_.fail(file_.lines().empty() ? 0 : 1, "is not a TRC file: its five header lines begin with PathFileType");
    }
    read_header();
    read_names();
    read_rows();
    return std::move(motion_);
  }

 private:
  std::string_view header(std::string_view key) const;
  double header_number(std::string_view key) const;
  void read_header();
  void read_names();
  void read_rows();
  void read_row(std::size_t line, Index row);
  double number(std::size_t line, std::string_view cell) const;

  const TextFile file_;
  Index frames_ = 0;
  Index marker_count_ = 0;
  double millimetres_ = 1;
  TrcMotion motion_;
};

/// The value in line 3 below the title `key` in line 2.
std::string_view Reader::header(std::string_view key) const {
  const std::vector<std::string_view> keys = fields(file_.lines()[1]);
  const std::vector<std::string_view> values = fields(file_.lines()[2]);
  const std::size_t column = static_cast<std::size_t>(std::find(keys.begin(), keys.end(), key) - keys.begin());
  if (column == keys.size()) file_.fail(2, "the header has no " + in_quotes(key));
  if (column >= values.size() || values[column].empty()) file_.fail(3, "no value for " + in_quotes(key));
  return values[column];
}

double Reader::header_number(std::string_view key) const {
  const double value = number(3, header(key));
  if (!(value > 0)) file_.fail(3, std::string(key) + " must be positive");
  return value;
}

void Reader::read_header() {
  motion_.rate = header_number("DataRate");
  const double frames = header_number("NumFrames"), markers = header_number("NumMarkers");
  if (frames != std::floor(frames) || markers != std::floor(markers) || frames > 1e7 || markers > 1e5) {
    file_.fail(3, "NumFrames and NumMarkers must be whole numbers of a sensible size");
  }
  frames_ = static_cast<Index>(frames);
  marker_count_ = static_cast<Index>(markers);
  const std::string_view unit = header("Units");
  if (unit != "mm" && unit != "cm" && unit != "m") {
    file_.fail(3, "unknown unit " + in_quotes(unit) + ", it can be mm, cm or m");
  }
  millimetres_ = unit == "mm" ? 1 : unit == "cm" ? 10 : 1000;
}

void Reader::read_names() {
  std::vector<std::string_view> names = fields(file_.lines()[3]);
  drop_empty_tail(names, 0);
  if (names.size() < 2 || names[0] != "Frame#" || names[1] != "Time") file_.fail(4, "must begin with Frame# and Time");
  for (std::size_t i = 2; i < names.size(); ++i) {
    const bool name_expected = (i - 2) % 3 == 0;
    if (name_expected == names[i].empty()) {
      file_.fail(
          4, "field " + std::to_string(i + 1) + ": a marker's name stands above its X, the next two fields are empty");
    }
    if (!name_expected) continue;
    if (motion_.find(std::string(names[i])) >= 0) file_.fail(4, "two markers are called " + in_quotes(names[i]));
    motion_.markers.emplace_back(names[i]);
  }
  if (std::ssize(motion_.markers) != marker_count_) {
    file_.fail(
        4, std::to_string(motion_.markers.size()) + " marker names, NumMarkers says " + std::to_string(marker_count_));
  }
}

void Reader::read_rows() {
  motion_.positions.resize(frames_, 3 * marker_count_);
  Index row = 0;
  for (std::size_t i = 5; i < file_.lines().size(); ++i) {
    if (trimmed(file_.lines()[i]).empty()) continue;
    if (row == frames_) file_.fail(i + 1, "more frames than NumFrames = " + std::to_string(frames_));
    read_row(i + 1, row++);
  }
  if (row < frames_) {
    file_.fail(file_.lines().size(), "the file ends after " + std::to_string(row) + " of " + std::to_string(frames_) +
                                         " frames, it is cut off");
  }
}

void Reader::read_row(std::size_t line, Index row) {
  std::vector<std::string_view> cells = fields(file_.lines()[line - 1]);
  const std::size_t expected = static_cast<std::size_t>(2 + 3 * marker_count_);
  drop_empty_tail(cells, expected);
  if (cells.size() != expected) {
    file_.fail(line, std::to_string(cells.size()) + " fields, " + std::to_string(marker_count_) + " markers need " +
                         std::to_string(expected));
  }
  const std::optional<std::int64_t> frame = parse_integer(cells[0]);
  if (!frame) file_.fail(line, "frame number " + in_quotes(cells[0]) + " is not a whole number");
  const double time = number(line, cells[1]);
  if (row == 0) {
    motion_.first_frame = *frame;
    motion_.first_time = time;
  }
  if (*frame != motion_.first_frame + row) file_.fail(line, "frame numbers must go up by one");
  if (std::abs(time - motion_.first_time - static_cast<double>(row) / motion_.rate) > 0.5 / motion_.rate) {
    file_.fail(line, "the time does not follow from DataRate");
  }
  for (Index marker = 0; marker < marker_count_; ++marker) {
    const std::string_view* const xyz = &cells[static_cast<std::size_t>(2 + 3 * marker)];
    const auto unseen = std::count_if(xyz, xyz + 3, means_not_seen);
    if (unseen != 0 && unseen != 3) {
      file_.fail(line, "marker '" + motion_.markers[static_cast<std::size_t>(marker)] +
                           "' has only some of its three coordinates, give all or none");
    }
    for (Index i = 0; i < 3; ++i) {
      motion_.positions(row, 3 * marker + i) = unseen ? not_seen : millimetres_ * number(line, xyz[i]);
    }
  }
}

double Reader::number(std::size_t line, std::string_view cell) const {
  const std::optional<double> value = parse_number(cell);
  if (!value) file_.fail(line, in_quotes(cell) + " is not a finite number");
  return *value;
}

}  // namespace

Index TrcMotion::find(const std::string& name) const {
  const auto found = std::find(markers.begin(), markers.end(), name);
  return found == markers.end() ? -1 : found - markers.begin();
}

std::optional<Vec3> TrcMotion::position(Index frame, Index marker) const {
  const Vec3 position = positions.row(frame).segment<3>(3 * marker).transpose();
  if (std::isnan(position.x())) return std::nullopt;
  return position;
}

TrcMotion read_trc(const std::filesystem::path& path) { return Reader(path).read(); }

}  // namespace skinbem
