#include <locograph/common/error.h>
#include <locograph/common/input_file.h>
#include <locograph/common/parse_number.h>
#include <locograph/world/point_cloud.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <string_view>

namespace locograph {
namespace {

static_assert(std::endian::native == std::endian::little, "PCD files are read in place");

enum class Layout { kText, kBinary, kCompressed };

struct Field {
  std::string name;
  char type = 'F';
  std::size_t size = 4, count = 1;
  std::size_t first_word = 0;  ///< of a line of text
  std::size_t first_byte = 0;  ///< of a point's record
};

struct PcdHeader {
  std::array<Field, 3> xyz;
  std::size_t words = 0, bytes = 0;  ///< of one point
  std::size_t width = 0, height = 0, points = 0;
  Layout layout = Layout::kText;
  std::size_t data_begin = 0;
  int data_line = 0;  ///< the last of the header
};

std::string printable(std::string_view text) {
  std::string out(text.substr(0, 40));
  std::replace_if(
      out.begin(), out.end(), [](unsigned char c) { return c < 32 || c > 126; }, '?');
  return out;
}

std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view kBlank = " \t\r\v\f";
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(kBlank); at != std::string_view::npos;
       at = line.find_first_not_of(kBlank, at)) {
    const std::size_t end = std::min(line.find_first_of(kBlank, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

class PcdHeaderReader {
 public:
  PcdHeaderReader(const std::string& file, std::string_view content)
      : file_(file), content_(content) {}

  PcdHeader read() {
    while (!entries_.contains("DATA")) next_entry();
    PcdHeader header;
    header.data_begin = position_;
    header.data_line = line_;
    header.layout = layout();
    std::vector<Field> fields = named_fields();
    sizes_and_types(fields);
    lay_out(fields, header);
    header.points = number_of_points();
    header.width = number("WIDTH");
    header.height = number("HEIGHT");
    return header;
  }

  /// After read(). The identity where the file has none.
  Eigen::Isometry3d viewpoint() const {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    if (!entries_.contains("VIEWPOINT")) return pose;
    const Entry& found = entries_.at("VIEWPOINT");
    Eigen::Matrix<double, 7, 1> numbers = Eigen::Matrix<double, 7, 1>::Zero();
    bool read = found.values.size() == 7;
    for (int i = 0; read && i < 7; ++i) {
      read = parse_number(found.values[static_cast<std::size_t>(i)], numbers[i]);
    }
    const Eigen::Quaterniond rotation(numbers[3], numbers[4], numbers[5], numbers[6]);
    if (!read || !numbers.allFinite() || std::abs(rotation.norm() - 1.0) > 1e-3) {
      fail(found.line, "VIEWPOINT is no pose",
           "tx ty tz qw qx qy qz with a quaternion of length 1");
    }
    pose.translation() = numbers.head<3>();
    pose.linear() = rotation.normalized().toRotationMatrix();
    return pose;
  }

 private:
  struct Entry {
    std::vector<std::string_view> values;
    int line = 0;
  };

  void next_entry() {
    const std::size_t end = content_.find('\n', position_);
    ++line_;
    if (end == std::string_view::npos) {
      if (line_ == 1) fail(line_, "not a PCD file", "a header from VERSION to DATA");
      fail(line_, "truncated in the header", "a line DATA");
    }
    std::vector<std::string_view> words = words_of(content_.substr(position_, end - position_));
    position_ = end + 1;
    if (words.empty() || words.front().front() == '#') return;
    const std::string key(words.front() == "COLUMNS" ? "FIELDS" : words.front());
    constexpr std::array<std::string_view, 10> kKeys{"VERSION", "FIELDS",   "SIZE",   "TYPE",
                                                     "COUNT",   "WIDTH",    "HEIGHT", "POINTS",
                                                     "DATA",    "VIEWPOINT"};
    if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end()) {
      fail(line_, "unknown header entry '" + printable(key) + "'",
           "VERSION, FIELDS, SIZE, TYPE, COUNT, WIDTH, HEIGHT, VIEWPOINT, POINTS or DATA");
    }
    words.erase(words.begin());
    if (!entries_.emplace(key, Entry{std::move(words), line_}).second) {
      fail(line_, "a second " + key, "one");
    }
  }

  Layout layout() const {
    const Entry& data = entries_.at("DATA");
    if (data.values.size() == 1) {
      if (data.values[0] == "ascii") return Layout::kText;
      if (data.values[0] == "binary") return Layout::kBinary;
      if (data.values[0] == "binary_compressed") return Layout::kCompressed;
    }
    fail(data.line, "unknown kind of data", "DATA ascii, binary or binary_compressed");
  }

  const Entry& entry(const std::string& key) const {
    const auto found = entries_.find(key);
    if (found == entries_.end()) fail(line_, "no " + key + " before DATA", "a line " + key);
    return found->second;
  }

  std::vector<Field> named_fields() const {
    std::vector<Field> fields;
    for (const std::string_view name : entry("FIELDS").values) {
      fields.emplace_back().name = std::string(name);
    }
    return fields;
  }

  /// The values of an entry that has one for each field.
  const Entry& for_each_field(const std::string& key, const std::vector<Field>& fields) const {
    const Entry& found = entry(key);
    if (found.values.size() != fields.size()) {
      fail(found.line, key + " of " + std::to_string(found.values.size()) + " fields",
           "one for each of the " + std::to_string(fields.size()) + " FIELDS");
    }
    return found;
  }

  void sizes_and_types(std::vector<Field>& fields) const {
    const Entry& sizes = for_each_field("SIZE", fields);
    const Entry& types = for_each_field("TYPE", fields);
    for (std::size_t f = 0; f < fields.size(); ++f) {
      Field& field = fields[f];
      if (!parse_number(sizes.values[f], field.size) || !std::has_single_bit(field.size) ||
          field.size > 8) {
        fail(sizes.line, "SIZE " + printable(sizes.values[f]), "1, 2, 4 or 8");
      }
      field.type = types.values[f].front();
      if (types.values[f].size() != 1 || std::string_view("IUF").find(field.type) > 2) {
        fail(types.line, "TYPE " + printable(types.values[f]), "I, U or F");
      }
    }
    if (!entries_.contains("COUNT")) return;
    const Entry& counts = for_each_field("COUNT", fields);
    for (std::size_t f = 0; f < fields.size(); ++f) {
      if (!parse_number(counts.values[f], fields[f].count) || fields[f].count < 1 ||
          fields[f].count > content_.size()) {
        fail(counts.line, "COUNT " + printable(counts.values[f]),
             "a number from 1 that the file has room for");
      }
    }
  }

  void lay_out(std::vector<Field>& fields, PcdHeader& header) const {
    // Sums stay far below an overflow: of names in the file, times counts below its size.
    for (Field& field : fields) {
      field.first_word = header.words;
      field.first_byte = header.bytes;
      header.words += field.count;
      header.bytes += field.count * field.size;
    }
    const int line = entry("FIELDS").line;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string name(1, "xyz"[axis]);
      const auto named = [&](const Field& field) { return field.name == name; };
      const auto found = std::find_if(fields.begin(), fields.end(), named);
      if (found == fields.end() || std::count_if(fields.begin(), fields.end(), named) != 1) {
        fail(line, (found == fields.end() ? "no field " : "several fields ") + name,
             "one x, one y and one z");
      }
      if (found->type != 'F' || found->size < 4 || found->count != 1) {
        fail(line, "field " + name + " is not one number of TYPE F and SIZE 4 or 8",
             "a float or a double");
      }
      header.xyz[axis] = *found;
    }
  }

  std::size_t number(const std::string& key) const {
    const Entry& found = entry(key);
    std::size_t value = 0;
    if (found.values.size() != 1 || !parse_number(found.values[0], value)) {
      fail(found.line, "unreadable " + key, "one whole number");
    }
    return value;
  }

  std::size_t number_of_points() const {
    const std::size_t width = number("WIDTH"), height = number("HEIGHT");
    const int line = entry("HEIGHT").line;
    if (height != 0 && width > std::numeric_limits<std::size_t>::max() / height) {
      fail(line, "WIDTH times HEIGHT is more than any file holds", "the number of points");
    }
    if (entries_.contains("POINTS") && number("POINTS") != width * height) {
      fail(entry("POINTS").line, "POINTS is not WIDTH times HEIGHT",
           std::to_string(width * height));
    }
    return width * height;
  }

  [[noreturn]] void fail(int line, const std::string& what, const std::string& expected) const {
    throw Error(file_, line, what, expected);
  }

  const std::string& file_;
  std::string_view content_;
  std::map<std::string, Entry> entries_;
  std::size_t position_ = 0;
  int line_ = 0;
};

[[noreturn]] void fail_truncated(const std::string& file, int line, const std::string& found,
                                 std::size_t points) {
  throw Error(file, line, "truncated: " + found,
              "the " + std::to_string(points) + " points of its header");
}

std::vector<Eigen::Vector3d> read_text(const std::string& file, const PcdHeader& header,
                                       std::string_view data) {
  std::vector<Eigen::Vector3d> points;
  // A line has a digit and a line end at least.
  points.reserve(std::min(header.points, data.size() / 2 + 1));
  std::size_t position = 0;
  int line = header.data_line;
  while (position < data.size()) {
    const std::size_t end = std::min(data.find('\n', position), data.size());
    const std::vector<std::string_view> words = words_of(data.substr(position, end - position));
    position = end + 1;
    ++line;
    if (words.empty()) continue;
    if (points.size() == header.points) {
      throw Error(file, line, "more points than the header says", std::to_string(header.points));
    }
    if (words.size() != header.words) {
      throw Error(file, line, "a point of " + std::to_string(words.size()) + " numbers",
                  std::to_string(header.words));
    }
    Eigen::Vector3d point;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = words[header.xyz[static_cast<std::size_t>(axis)].first_word];
      if (!parse_number(word, point[axis])) {
        throw Error(file, line, "unreadable coordinate '" + printable(word) + "'", "a number");
      }
    }
    points.push_back(point);
  }
  if (points.size() < header.points) {
    fail_truncated(file, line, std::to_string(points.size()) + " points", header.points);
  }
  return points;
}

double coordinate(const char* at, std::size_t size) {
  if (size == 8) {
    double value = 0.0;
    std::memcpy(&value, at, sizeof value);
    return value;
  }
  float value = 0.0f;
  std::memcpy(&value, at, sizeof value);
  return static_cast<double>(value);
}

std::vector<Eigen::Vector3d> read_records(const std::string& file, const PcdHeader& header,
                                          std::string_view data) {
  if (header.points > data.size() / header.bytes) {
    fail_truncated(file, 0, std::to_string(data.size()) + " bytes of data", header.points);
  }
  std::vector<Eigen::Vector3d> points;
  points.reserve(header.points);
  for (std::size_t p = 0; p < header.points; ++p) {
    const char* record = data.data() + p * header.bytes;
    Eigen::Vector3d point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Field& field = header.xyz[axis];
      point[static_cast<int>(axis)] = coordinate(record + field.first_byte, field.size);
    }
    points.push_back(point);
  }
  return points;
}

/// LibLZF's format: a byte below 32 says how many literal bytes follow, less one; others give
/// length and distance of a copy from what is out already, which may overlap itself. False when
/// the result has not exactly `size` bytes.
bool expand_lzf(std::string_view in, std::size_t size, std::string& out) {
  out.clear();
  out.reserve(size);
  std::size_t at = 0;
  while (at < in.size()) {
    const std::size_t control = static_cast<unsigned char>(in[at++]);
    if (control < 32) {
      const std::size_t length = control + 1;
      if (length > in.size() - at || length > size - out.size()) return false;
      out.append(in.substr(at, length));
      at += length;
      continue;
    }
    std::size_t length = control >> 5;
    if (length == 7) {
      if (at == in.size()) return false;
      length += static_cast<unsigned char>(in[at++]);
    }
    length += 2;
    if (at == in.size()) return false;
    const std::size_t back = ((control & 31) << 8 | static_cast<unsigned char>(in[at++])) + 1;
    if (back > out.size() || length > size - out.size()) return false;
    for (std::size_t from = out.size() - back, i = 0; i < length; ++i) {
      out.push_back(out[from + i]);
    }
  }
  return out.size() == size;
}

std::vector<Eigen::Vector3d> read_compressed(const std::string& file, const PcdHeader& header,
                                             std::string_view data) {
  if (header.points == 0 && data.empty()) return {};
  std::array<std::uint32_t, 2> sizes{};  // compressed, expanded
  if (data.size() < sizeof sizes) {
    fail_truncated(file, 0, std::to_string(data.size()) + " bytes of data", header.points);
  }
  std::memcpy(sizes.data(), data.data(), sizeof sizes);
  data.remove_prefix(sizeof sizes);
  if (sizes[0] > data.size()) {
    fail_truncated(file, 0,
                   std::to_string(data.size()) + " of " + std::to_string(sizes[0]) +
                       " bytes of compressed data",
                   header.points);
  }
  const std::size_t expanded = sizes[1];
  if (header.points > expanded / header.bytes || header.points * header.bytes != expanded) {
    throw Error(file, 0, "compressed data of " + std::to_string(expanded) + " bytes",
                std::to_string(header.points) + " points of " + std::to_string(header.bytes));
  }
  // Three bytes expand to 264 at most.
  std::string fields;
  if (expanded / 88 > sizes[0] || !expand_lzf(data.substr(0, sizes[0]), expanded, fields)) {
    throw Error(file, 0, "damaged compressed data", "LZF of its header's size");
  }
  // All points' values of the first field, then all of the second, ...
  std::vector<Eigen::Vector3d> points;
  points.reserve(header.points);
  for (std::size_t p = 0; p < header.points; ++p) {
    Eigen::Vector3d point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Field& field = header.xyz[axis];
      const char* first = fields.data() + field.first_byte * header.points;
      point[static_cast<int>(axis)] = coordinate(first + p * field.size, field.size);
    }
    points.push_back(point);
  }
  return points;
}

/// All of them, those that are not finite too.
std::vector<Eigen::Vector3d> read_points(const std::string& file, const PcdHeader& header,
                                         std::string_view data) {
  switch (header.layout) {
    case Layout::kText:
      return read_text(file, header, data);
    case Layout::kBinary:
      return read_records(file, header, data);
    case Layout::kCompressed:
      return read_compressed(file, header, data);
  }
  return {};
}

/// place: whether the viewpoint is wanted, and refused if it is damaged.
PointCloud read_pcd(const std::filesystem::path& path, bool place) {
  const std::string file = path.string();
  const std::string content = read_file(path, kMostInputBytes, "a point cloud (PCD)");
  if (content.empty()) throw Error(file, 0, "is empty", "a point cloud (PCD)");
  PcdHeaderReader reader(file, content);
  const PcdHeader header = reader.read();
  PointCloud cloud;
  if (place) cloud.viewpoint = reader.viewpoint();
  cloud.width = header.width;
  cloud.height = header.height;
  cloud.points = read_points(file, header, std::string_view(content).substr(header.data_begin));
  return cloud;
}

}  // namespace

PointCloud read_point_cloud(const std::filesystem::path& path) { return read_pcd(path, true); }

std::vector<Eigen::Vector3d> load_point_cloud(const std::filesystem::path& path) {
  std::vector<Eigen::Vector3d> points = read_pcd(path, false).points;
  std::erase_if(points, [](const Eigen::Vector3d& point) { return !point.allFinite(); });
  if (points.empty()) throw Error(path.string(), 0, "holds no finite point", "points");
  return points;
}

}  // namespace locograph
