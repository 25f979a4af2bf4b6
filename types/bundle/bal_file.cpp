#include <locograph/common/input_file.h>
#include <locograph/types/bundle/bal_file.h>
#include <locograph/types/bundle/camera_bal.h>
#include <locograph/types/bundle/inverse_depth.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace locograph {
namespace {

/// Numbers separated by blanks and line ends, each found on its line.
class NumberReader {
 public:
  NumberReader(std::string_view text, const std::string& name)
      : at_(text.data()), end_(text.data() + text.size()), name_(name) {}

  int integer(const char* what, int most) {
    const long value = read<long>(what);
    if (value < 0 || value > most) {
      fail(std::string(what) + " " + std::to_string(value), "0 to " + std::to_string(most));
    }
    return static_cast<int>(value);
  }
  double number(const char* what) {
    const double value = read<double>(what);
    if (!std::isfinite(value)) fail(std::string(what) + " is not finite", "a finite number");
    return value;
  }
  void expect_end() {
    skip_blanks();
    if (at_ != end_) fail("more than the first line announced", "the end of the file");
  }
  [[noreturn]] void fail(const std::string& what, const std::string& expected) const {
    throw Error(name_, line_, what, expected);
  }

 private:
  static bool blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
  void skip_blanks() {
    for (; at_ != end_ && blank(*at_); ++at_) line_ += *at_ == '\n' ? 1 : 0;
  }
  template <class T>
  T read(const char* what) {
    skip_blanks();
    if (at_ == end_) fail("the file ends", what);
    if (*at_ == '+') ++at_;
    T value{};
    const auto [next, error] = std::from_chars(at_, end_, value);
    if (error != std::errc() || (next != end_ && !blank(*next))) {
      const char* stop = std::find_if(at_, end_, blank);
      fail("'" + std::string(at_, std::min(stop, at_ + 40)) + "'", what);
    }
    at_ = next;
    return value;
  }

  const char* at_;
  const char* end_;
  const std::string& name_;
  int line_ = 1;
};

constexpr int kMostItems = 100'000'000;

template <class V>
bool holds(const VertexPool& pool) {
  return pool.type() == typeid(V);
}

}  // namespace

Graph read_bal_text(std::string_view text, const std::string& name) {
  NumberReader in(text, name);
  const int cameras = in.integer("number of cameras", kMostItems);
  const int points = in.integer("number of points", kMostItems);
  const int observations = in.integer("number of observations", kMostItems);
  if (cameras == 0 || points == 0 || observations == 0) {
    in.fail("a problem without cameras, points or observations", "one or more of each");
  }
  // A digit and a blank for each number: do not reserve memory for what cannot follow.
  const double numbers = 4.0 * observations + 9.0 * cameras + 3.0 * points;
  if (2.0 * numbers > static_cast<double>(text.size()) + 1.0) {
    in.fail("the file is too short for " + std::to_string(observations) + " observations",
            "as many numbers as its first line announces");
  }
  struct Observation {
    int camera, point;
    double x, y;
  };
  std::vector<Observation> seen(observations);
  for (Observation& o : seen) {
    o.camera = in.integer("index of a camera", cameras - 1);
    o.point = in.integer("index of a point", points - 1);
    o.x = in.number("x of an observation");
    o.y = in.number("y of an observation");
  }
  Graph graph;
  std::vector<VertexId<VertexCameraBAL>> camera_ids;
  std::vector<VertexId<VertexPointXYZ>> point_ids;
  for (int c = 0; c < cameras; ++c) {
    VertexCameraBAL camera;
    for (int i = 0; i < 9; ++i) camera.state[i] = in.number("parameter of a camera");
    camera_ids.push_back(graph.add_vertex(c, camera));
  }
  for (int p = 0; p < points; ++p) {
    VertexPointXYZ point;
    for (int i = 0; i < 3; ++i) point.state[i] = in.number("coordinate of a point");
    point_ids.push_back(graph.add_vertex(cameras + p, point));
    graph.set_eliminate(point_ids.back().slot, true);
  }
  in.expect_end();
  EdgeProjectBAL edge;
  for (const Observation& o : seen) {
    edge.measurement << o.x, o.y;
    graph.add_edge(edge, camera_ids[o.camera], point_ids[o.point]);
  }
  return graph;
}

Graph read_bal(const std::filesystem::path& file) {
  return read_bal_text(read_file(file, kMostInputBytes, "a bundle adjustment file"), file.string());
}

bool looks_like_bal(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return false;
  const std::string_view line = text.substr(begin, text.find('\n', begin) - begin);
  int words = 0;
  bool inside = false;
  for (const char c : line) {
    const bool digit = c >= '0' && c <= '9', blank = c == ' ' || c == '\t' || c == '\r';
    if (!digit && !blank) return false;
    if (digit && !inside) ++words;
    inside = digit;
  }
  return words == 3;
}

int mark_points_for_elimination(Graph& graph) {
  const auto is_point = [&](int slot) {
    const VertexPool& pool = *graph.vertex_pools()[graph.vertex_record(slot).pool];
    return holds<VertexPointXYZ>(pool) || holds<VertexInverseDepth>(pool);
  };
  int points = 0, others = 0;
  for (int v = 0; v < graph.vertex_slots(); ++v) {
    if (graph.vertex_alive(v)) ++(is_point(v) ? points : others);
  }
  if (points <= others) return 0;
  for (int e = 0; e < graph.edge_slots(); ++e) {
    if (!graph.edge_alive(e)) continue;
    const std::span<const int> vertices = graph.edge_vertices(e);
    if (std::count_if(vertices.begin(), vertices.end(), is_point) > 1) return 0;
  }
  for (int v = 0; v < graph.vertex_slots(); ++v) {
    if (graph.vertex_alive(v) && is_point(v)) graph.set_eliminate(v, true);
  }
  return points;
}

}  // namespace locograph
