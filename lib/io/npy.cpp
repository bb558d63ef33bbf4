// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/io/npy.hpp>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <skinbem/base/atomic_file.hpp>
#include <skinbem/base/error.hpp>
#include <skinbem/base/types.hpp>

namespace skinbem {
namespace {

static_assert(std::endian::native == std::endian::little, "files are written as the little-endian machine holds them");

constexpr std::string_view magic("\x93NUMPY", 6);
constexpr std::size_t alignment = 64;  // of the first entry within the file, as the format asks

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what) {
  throw Error(ErrorCode::bad_input, path.string() + ": " + what);
}

struct Header {
  std::size_t scalar_size = 0;  // 4 or 8 bytes
  bool big_endian = false;
  bool fortran_order = false;
  std::size_t rows = 0, columns = 0;
};

/// Reads the Python dictionary of an NPY header: its three keys, each once, in any order, and nothing else.
class HeaderParser {
 public:
  HeaderParser(const std::filesystem::path& path, std::string_view text) : path_(path), text_(text) {}

  Header parse() {
    expect("{");
    while (!accept("}")) {
      entry(quoted());
      if (!accept(",")) {
        expect("}");
        break;
      }
    }
    skip_spaces();
    if (!text_.empty()) fail("text after the header's dictionary");
    if (!descr_ || !order_ || !shape_) fail("the header lacks 'descr', 'fortran_order' or 'shape'");
    return header_;
  }

 private:
  void entry(std::string_view key) {
    expect(":");
    if (key == "descr" && !descr_) {
      descr_ = true;
      descr(quoted());
    } else if (key == "fortran_order" && !order_) {
      order_ = true;
      header_.fortran_order = accept("True");
      if (!header_.fortran_order) expect("False");
    } else if (key == "shape" && !shape_) {
      shape_ = true;
      shape();
    } else {
      fail("unknown or repeated key '" + std::string(key) + "' in the header");
    }
  }

  void descr(std::string_view value) {
    if (value != "<f8" && value != "<f4" && value != ">f8" && value != ">f4") {
      refuse(path_, "holds entries of type '" + std::string(value) + "', save it as float64 or float32");
    }
    header_.big_endian = value[0] == '>';
    header_.scalar_size = value[2] == '8' ? 8 : 4;
  }

  void shape() {
    std::vector<std::size_t> extents;
    expect("(");
    while (!accept(")")) {
      extents.push_back(number());
      if (!accept(",")) {
        expect(")");
        break;
      }
    }
    if (extents.size() != 2) {
      refuse(path_, "holds an array of " + std::to_string(extents.size()) + " dimensions, a matrix has two");
    }
    header_.rows = extents[0];
    header_.columns = extents[1];
  }

  std::size_t number() {
    skip_spaces();
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    if (error != std::errc()) fail("a number was expected in the header's shape");
    text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
    return value;
  }

  std::string_view quoted() {
    skip_spaces();
    if (text_.empty() || (text_[0] != '\'' && text_[0] != '"')) fail("a quoted word was expected in the header");
    const std::size_t end = text_.find(text_[0], 1);
    if (end == std::string_view::npos) fail("a quoted word of the header does not end");
    const std::string_view word = text_.substr(1, end - 1);
    text_.remove_prefix(end + 1);
    return word;
  }

  void skip_spaces() { text_.remove_prefix(std::min(text_.find_first_not_of(" \t\n"), text_.size())); }
  bool accept(std::string_view token) {
    skip_spaces();
    if (!text_.starts_with(token)) return false;
    text_.remove_prefix(token.size());
    return true;
  }
  void expect(std::string_view token) {
    if (!accept(token)) fail(std::string("'").append(token) + "' was expected in the header");
  }
  [[noreturn]] void fail(const std::string& what) const { refuse(path_, what + ", is it an NPY file of NumPy?"); }

  const std::filesystem::path& path_;
  std::string_view text_;
  Header header_;
  bool descr_ = false, order_ = false, shape_ = false;
};

/// Splits the file into its parsed header and the bytes of its entries.
std::pair<Header, std::string_view> split(const std::filesystem::path& path, std::string_view file) {
  if (!file.starts_with(magic)) refuse(path, "is not an NPY file (its first bytes are not those of the format)");
  if (file.size() < 12) refuse(path, "ends within its header, the file is truncated");
  const int major = static_cast<unsigned char>(file[6]);
  if (major != 1 && major != 2) refuse(path, "has NPY format " + std::to_string(major) + ", save it as 1.0 or 2.0");
  const std::size_t length_bytes = major == 1 ? 2 : 4;
  std::uint32_t length = 0;
  std::memcpy(&length, file.data() + 8, length_bytes);
  const std::size_t begin = 8 + length_bytes;
  if (file.size() - begin < length) refuse(path, "ends within its header, the file is truncated");
  return {HeaderParser(path, file.substr(begin, length)).parse(), file.substr(begin + length)};
}

template <class Bits, class Scalar>
double entry_at(std::string_view bytes, std::size_t i, bool big_endian) {
  Bits bits;
  std::memcpy(&bits, bytes.data() + i * sizeof(Bits), sizeof(Bits));
  if (big_endian)
    bits = sizeof(Bits) == 8 ? static_cast<Bits>(__builtin_bswap64(bits))
                             : static_cast<Bits>(__builtin_bswap32(static_cast<std::uint32_t>(bits)));
  return static_cast<double>(std::bit_cast<Scalar>(bits));
}

std::string header_text(const Eigen::Ref<const Eigen::MatrixXd>& matrix, NpyType type) {
  std::string text = std::string("{'descr': '") + (type == NpyType::float64 ? "<f8" : "<f4") +
                     "', 'fortran_order': False, 'shape': (" + std::to_string(matrix.rows()) + ", " +
                     std::to_string(matrix.cols()) + "), }";
  constexpr std::size_t fixed = magic.size() + 4;
  text.append(alignment - (fixed + text.size() + 1) % alignment, ' ');
  return text + '\n';
}

}  // namespace

void write_npy(const std::filesystem::path& path, const Eigen::Ref<const Eigen::MatrixXd>& matrix, NpyType type) {
  const double limit =
      type == NpyType::float32 ? std::numeric_limits<float>::max() : std::numeric_limits<double>::max();
  for (Index j = 0; j < matrix.cols(); ++j) {
    for (Index i = 0; i < matrix.rows(); ++i) {
      if (!(std::abs(matrix(i, j)) <= limit)) {
        throw Error(ErrorCode::numerical, path.string() + ": not written, entry (" + std::to_string(i) + ", " +
                                              std::to_string(j) + ") of the matrix is not finite");
      }
    }
  }
  const std::string header = header_text(matrix, type);
  write_file_atomically(path, [&](std::ostream& out) {
    const auto length = static_cast<std::uint16_t>(header.size());
    out.write(magic.data(), magic.size());
    out.write("\x01\x00", 2);
    out.write(reinterpret_cast<const char*>(&length), sizeof length);
    out.write(header.data(), static_cast<std::streamsize>(header.size()));
    // Row by row, so that no second copy of a large matrix is needed.
    for (Index i = 0; i < matrix.rows(); ++i) {
      if (type == NpyType::float64) {
        const Eigen::RowVectorXd row = matrix.row(i);
        out.write(reinterpret_cast<const char*>(row.data()), row.size() * 8);
      } else {
        const Eigen::RowVectorXf row = matrix.row(i).cast<float>();
        out.write(reinterpret_cast<const char*>(row.data()), row.size() * 4);
      }
    }
  });
}

Eigen::MatrixXd read_npy(const std::filesystem::path& path) {
  const std::string file = read_file(path);
  const auto [header, bytes] = split(path, file);
  const std::size_t present = bytes.size() / header.scalar_size;
  // Rows and columns are checked one after the other, so that a product that overflows cannot pass.
  const bool fits = header.columns == 0 || header.rows <= present / header.columns;
  if (!fits || header.rows * header.columns * header.scalar_size != bytes.size()) {
    refuse(path, "holds " + std::to_string(bytes.size()) + " bytes of entries, its shape (" +
                     std::to_string(header.rows) + ", " + std::to_string(header.columns) +
                     ") needs another number, the file is damaged");
  }
  Eigen::MatrixXd matrix(header.rows, header.columns);
  for (std::size_t i = 0; i < header.rows; ++i) {
    for (std::size_t j = 0; j < header.columns; ++j) {
      const std::size_t at = header.fortran_order ? i + j * header.rows : i * header.columns + j;
      const double value = header.scalar_size == 8 ? entry_at<std::uint64_t, double>(bytes, at, header.big_endian)
                                                   : entry_at<std::uint32_t, float>(bytes, at, header.big_endian);
      if (!std::isfinite(value)) {
        refuse(path, "entry (" + std::to_string(i) + ", " + std::to_string(j) + ") is not finite");
      }
      matrix(static_cast<Index>(i), static_cast<Index>(j)) = value;
    }
  }
  return matrix;
}

}  // namespace skinbem
