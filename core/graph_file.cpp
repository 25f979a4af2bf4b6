#include <locograph/common/atomic_file.h>
#include <locograph/common/input_file.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/information.h>
#include <locograph/core/initial_guess.h>

#include <algorithm>
#include <map>

namespace locograph {
namespace {

// What an edge's line may end in.
constexpr std::string_view kConstraintWord = "constraint";
struct NamedKind {
  std::string_view name;
  ConstraintKind kind;
};
constexpr NamedKind kKinds[] = {{"none", ConstraintKind::kNone},
                                {"equality", ConstraintKind::kEquality},
                                {"inequality", ConstraintKind::kInequality}};

struct Mark {
  ConstraintKind kind;
  double tolerance;
};

Mark read_mark(FieldReader& in) {
  in.word();
  const std::string name = in.at_end() ? "" : in.word();
  const auto named = std::find_if(std::begin(kKinds), std::end(kKinds),
                                  [&name](const NamedKind& k) { return k.name == name; });
  if (named == std::end(kKinds)) {
    in.fail("constraint '" + name + "'", "'none', 'equality' or 'inequality'");
  }
  return {named->kind, in.at_end() ? 0.0 : in.number()};
}

void write_mark(const Graph::EdgeRecord& record, ConstraintKind of_type, FieldWriter& out) {
  if (record.constraint == of_type && record.tolerance == 0.0) return;
  out.word(kConstraintWord);
  for (const NamedKind& named : kKinds) {
    if (named.kind == record.constraint) out.word(named.name);
  }
  if (record.tolerance > 0.0) out.number(record.tolerance);
}

/// Where the file is, behind links to it.
std::filesystem::path real_folder(const std::filesystem::path& path) {
  std::error_code failed;
  if (!std::filesystem::is_symlink(path, failed)) return path.parent_path();
  return std::filesystem::canonical(path, failed).parent_path();
}

}  // namespace

/// One file being read: sorts its lines by kind, so that they may come in any order.
class GraphReader {
 public:
  GraphReader(const std::string& name, const std::filesystem::path& folder,
              const TypeRegistry& types, const ReadOptions& options, ReadReport& report)
      : types_(types), options_(options), report_(report) {
    where_.file = name;
    where_.folder = folder;
  }

  Graph read(std::string_view text) {
    split(text);
    if (parameters_.empty() && vertices_.empty() && edges_.empty() && report_.unknown.empty()) {
      throw Error(where_.file, 0, "holds no graph", "VERTEX_… or EDGE_… lines");
    }
    lines_ = parameters_.size() + vertices_.size() + edges_.size() + fixes_.size();
    for (const Line& line : parameters_)
      at(line, [&](FieldReader& in) { read_parameter(line, in); });
    for (const Line& line : vertices_) at(line, [&](FieldReader& in) { read_vertex(line, in); });
    report_.vertices_from_edges = vertices_.empty() && !edges_.empty();
    for (const Line& line : edges_) at(line, [&](FieldReader& in) { read_edge(line, in); });
    for (const Line& line : fixes_) at(line, [&](FieldReader& in) { read_fix(in); });
    report_indefinite();
    if (report_.vertices_from_edges) initialise_from_edges(graph_);
    return std::move(graph_);
  }

 private:
  struct Line {
    int number;
    std::string_view tag;
    std::string_view fields;
    const void* type;
  };

  template <class F>
  void at(const Line& line, F&& read) {
    where_.line = line.number;
    if (options_.progress && ++lines_read_ % (lines_ / 256 + 1) == 0) {
      options_.progress(static_cast<double>(lines_read_) / static_cast<double>(lines_));
    }
    FieldReader in(line.fields, where_);
    try {
      read(in);
    } catch (const Error& error) {
      if (error.line() > 0) throw;
      throw Error(where_.file, line.number, error.what(), "");
    }
  }

  void split(std::string_view text) {
    int number = 0;
    while (!text.empty()) {
      ++number;
      const std::size_t end = text.find('\n');
      std::string_view line = text.substr(0, end);
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      line = line.substr(0, comment_start(line));
      const std::size_t first = line.find_first_not_of(" \t\r");
      if (first == std::string_view::npos) continue;
      line.remove_prefix(first);
      const std::size_t length = std::min(line.find_first_of(" \t\r"), line.size());
      sort_in({number, line.substr(0, length), line.substr(length), nullptr});
    }
  }

  static std::size_t comment_start(std::string_view line) {
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (line[i] == '"') quoted = !quoted;
      if (line[i] == '\\' && quoted) {
        ++i;
      } else if (line[i] == '#' && !quoted) {
        return i;
      }
    }
    return line.size();
  }

  void sort_in(Line line) {
    const std::string tag(line.tag);
    if (const auto* vertex = types_.vertex_type(tag)) {
      line.type = vertex;
      vertices_.push_back(line);
    } else if (const auto* edge = types_.edge_type(tag)) {
      line.type = edge;
      edges_.push_back(line);
    } else if (const auto* parameter = types_.parameter_type(tag)) {
      line.type = parameter;
      parameters_.push_back(line);
    } else if (tag == "FIX") {
      fixes_.push_back(line);
    } else if (const std::string* expected = types_.retired(tag)) {
      throw Error(where_.file, line.number, tag + " of an older format", *expected);
    } else {
      const Error error(where_.file, line.number, "unknown tag '" + tag + "'",
                        "a registered type (see: locograph list types)");
      if (!options_.lenient) throw error;
      report_.unknown.push_back(error.what());
    }
  }

  void read_parameter(const Line& line, FieldReader& in) {
    std::unique_ptr<Parameter> parameter =
        (*static_cast<const TypeRegistry::MakeParameter*>(line.type))();
    const int number = in.integer();
    in.set_parameters(&graph_.parameters_);
    parameter->read(in);
    in.expect_end();
    graph_.parameters_.set(number, std::move(parameter), line.number);
  }

  int pool_of(std::type_index type, std::unique_ptr<VertexPool> fresh) {
    for (std::size_t i = 0; i < graph_.vertex_pools_.size(); ++i) {
      if (graph_.vertex_pools_[i]->type() == type) return static_cast<int>(i);
    }
    graph_.vertex_pools_.push_back(std::move(fresh));
    return static_cast<int>(graph_.vertex_pools_.size()) - 1;
  }

  int pool_of(const TypeRegistry::VertexType& type) {
    const auto known = vertex_pool_of_type_.find(&type);
    if (known != vertex_pool_of_type_.end()) return known->second;
    return vertex_pool_of_type_[&type] = pool_of(type.type, type.make_pool());
  }

  void read_vertex(const Line& line, FieldReader& in) {
    const int pool = pool_of(*static_cast<const TypeRegistry::VertexType*>(line.type));
    const int id = in.integer();
    const int known = graph_.slot_of(id);
    if (known >= 0) {
      in.fail("vertex " + std::to_string(id) + " is declared twice, first on line " +
                  std::to_string(graph_.vertex_records_[known].line),
              "an id used once");
    }
    // Types that need parameters (a robot) find them here.
    in.set_parameters(&graph_.parameters_);
    const int index = graph_.vertex_pools_[pool]->read(in);
    in.expect_end();
    const int slot = graph_.add_vertex_record(id, pool, index);
    graph_.vertex_records_[slot].line = line.number;
    if (line.tag != graph_.vertex_pools_[pool]->tag()) {
      graph_.vertex_records_[slot].alias = alias_of(std::string(line.tag));
    }
  }

  int alias_of(const std::string& tag) {
    const auto found = std::find(graph_.aliases_.begin(), graph_.aliases_.end(), tag);
    if (found == graph_.aliases_.end()) graph_.aliases_.push_back(tag);
    return static_cast<int>(std::find(graph_.aliases_.begin(), graph_.aliases_.end(), tag) -
                            graph_.aliases_.begin());
  }

  int edge_pool_of(const TypeRegistry::MakeEdgePool& make) {
    const auto known = edge_pool_of_type_.find(&make);
    if (known != edge_pool_of_type_.end()) return known->second;
    std::unique_ptr<EdgePool> fresh = make();
    // Two tags may stand for one type.
    int number = 0;
    for (const auto& pool : graph_.edge_pools_) {
      if (pool->type() == fresh->type()) return edge_pool_of_type_[&make] = number;
      ++number;
    }
    graph_.edge_pools_.push_back(std::move(fresh));
    return edge_pool_of_type_[&make] = number;
  }

  void read_edge(const Line& line, FieldReader& in) {
    const int number = edge_pool_of(*static_cast<const TypeRegistry::MakeEdgePool*>(line.type));
    EdgePool& pool = *graph_.edge_pools_[number];
    slots_.clear();
    if (pool.arity() >= 0) {
      for (int i = 0; i < pool.arity(); ++i) slots_.push_back(vertex_of_edge(pool, i, line, in));
    } else {
      while (in.peek() != "||") {
        if (in.at_end()) in.fail("no '||' after the vertices", "TAG id… || n …");
        slots_.push_back(vertex_of_edge(pool, static_cast<int>(slots_.size()), line, in));
      }
      in.word();
      if (slots_.empty()) in.fail("an edge without vertices", "at least one id before '||'");
    }
    in.set_parameters(&graph_.parameters_);
    const int index = pool.read(slots_, in);
    // Rows of equal weight are written as one number; the pairs of 140 links are as many as these.
    constexpr int kMostRowsOfEqualWeight = 10'000;
    const int rows = pool.dimension(index);
    if (rows > kMostRowsOfEqualWeight && rows > static_cast<long>(line.fields.size())) {
      in.fail("an error of size " + std::to_string(rows),
              "at most " + std::to_string(kMostRowsOfEqualWeight) + " rows of equal weight");
    }
    Mark mark{pool.constraint(), 0.0};
    if (in.peek() == kConstraintWord) mark = read_mark(in);
    in.expect_end();
    pool.bind(index, graph_.parameters_);
    pool.check(index, graph_);
    check_information(pool, index, line.number);
    const EdgeId edge{graph_.add_edge_record(number, index, line.number)};
    if (mark.kind != ConstraintKind::kNone || pool.constraint() != ConstraintKind::kNone) {
      graph_.set_constraint(edge, mark.kind, mark.tolerance);
    }
  }

  int vertex_of_edge(const EdgePool& pool, int slot, const Line& line, FieldReader& in) {
    const int id = in.integer();
    int vertex = graph_.slot_of(id);
    if (vertex < 0) {
      if (!report_.vertices_from_edges) {
        in.fail("unknown vertex " + std::to_string(id), "an id declared by a VERTEX line");
      }
      if (pool.slot_type(slot) == typeid(void)) {
        in.fail("vertex " + std::to_string(id) + " is of no known type", "a VERTEX line for it");
      }
      const int pool_number = pool_of(pool.slot_type(slot), pool.make_slot_pool(slot));
      const int index = graph_.vertex_pools_[pool_number]->add_default();
      if (graph_.vertex_pools_[pool_number]->dimension(index) == 0) {
        in.fail("nothing says how large vertex " + std::to_string(id) + " is",
                "a " + graph_.vertex_pools_[pool_number]->tag() + " line for it");
      }
      vertex = graph_.add_vertex_record(id, pool_number, index);
      graph_.vertex_records_[vertex].line = line.number;
    }
    const Graph::VertexRecord& record = graph_.vertex_records_[vertex];
    if (pool.slot_type(slot) != typeid(void) &&
        graph_.vertex_pools_[record.pool]->type() != pool.slot_type(slot)) {
      in.fail("vertex " + std::to_string(id) + " is a " + graph_.vertex_tag(vertex),
              "a " + pool.make_slot_pool(slot)->tag());
    }
    const std::size_t place = static_cast<std::size_t>(vertex);
    if (place >= named_on_line_.size()) named_on_line_.resize(graph_.vertex_records_.size(), 0);
    if (named_on_line_[place] == line.number) {
      in.fail("the edge names vertex " + std::to_string(id) + " twice", "different vertices");
    }
    named_on_line_[place] = line.number;
    return vertex;
  }

  void check_information(EdgePool& pool, int index, int line) {
    if (pool.has_weights()) return;
    // Consecutive edges of real files mostly share their matrix: the last good one is remembered.
    Eigen::MatrixXd information = pool.information(index);
    if (information.rows() == last_good_.rows() && information == last_good_) return;
    if (is_positive_semidefinite(information)) {
      last_good_ = std::move(information);
      return;
    }
    if (report_.indefinite_information++ == 0) report_.first_indefinite_line = line;
    if (options_.lenient) pool.set_information(index, nearest_positive_semidefinite(information));
  }

  void report_indefinite() const {
    if (report_.indefinite_information == 0 || options_.lenient) return;
    throw Error(where_.file, report_.first_indefinite_line,
                "the information matrix is indefinite, the first of " +
                    std::to_string(report_.indefinite_information) + " such among " +
                    std::to_string(graph_.edge_count()) + " edges",
                "positive semi-definite matrices (--lenient projects them to the nearest ones)");
  }

  void read_fix(FieldReader& in) {
    do {
      const int id = in.integer();
      const int slot = graph_.slot_of(id);
      if (slot < 0) {
        in.fail("unknown vertex " + std::to_string(id), "an id declared by a VERTEX line");
      }
      graph_.set_fixed(slot, true);
    } while (!in.at_end());
  }

  const TypeRegistry& types_;
  const ReadOptions& options_;
  ReadReport& report_;
  FileLine where_;
  std::vector<Line> parameters_, vertices_, edges_, fixes_;
  std::size_t lines_ = 0, lines_read_ = 0;
  std::map<const void*, int> vertex_pool_of_type_, edge_pool_of_type_;
  std::vector<int> slots_;
  std::vector<int> named_on_line_;  ///< of each vertex slot the last line whose edge named it
  Eigen::MatrixXd last_good_;
  Graph graph_;
};

Graph read_graph_text(std::string_view text, const std::string& name,
                      const std::filesystem::path& folder, const TypeRegistry& types,
                      const ReadOptions& options, ReadReport* report) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // as some editors write it
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  ReadReport local;
  ReadReport& used = report == nullptr ? local : *report;
  used = {};
  return GraphReader(name, folder, types, options, used).read(text);
}

Graph read_graph(const std::filesystem::path& path, const TypeRegistry& types,
                 const ReadOptions& options, ReadReport* report) {
  const std::string text = read_file(path, kMostInputBytes, "a graph file");
  return read_graph_text(text, path.string(), real_folder(path), types, options, report);
}

std::string write_graph_text(const Graph& graph, const std::filesystem::path& folder) {
  FieldWriter out(folder);
  for (const auto& [number, parameter] : graph.parameters().all()) {
    out.tag(parameter->tag());
    out.integer(number);
    parameter->write(out);
    out.end_line();
  }
  for (int slot = 0; slot < graph.vertex_slots(); ++slot) {
    if (!graph.vertex_alive(slot)) continue;
    const Graph::VertexRecord& record = graph.vertex_record(slot);
    out.tag(graph.vertex_tag(slot));
    out.integer(record.id);
    graph.vertex_pools()[record.pool]->write(record.index, out);
    out.end_line();
    if (record.fixed) {
      out.tag("FIX");
      out.integer(record.id);
      out.end_line();
    }
  }
  for (int slot = 0; slot < graph.edge_slots(); ++slot) {
    if (!graph.edge_alive(slot)) continue;
    const Graph::EdgeRecord& record = graph.edge_record(slot);
    const EdgePool& pool = *graph.edge_pools()[record.pool];
    out.tag(pool.tag());
    for (const int v : pool.vertices(record.index)) out.integer(graph.vertex_record(v).id);
    if (pool.arity() < 0) out.tag(" ||");
    pool.write(record.index, out);
    write_mark(record, pool.constraint(), out);
    out.end_line();
  }
  return out.text();
}

void write_graph(const Graph& graph, const std::filesystem::path& path) {
  write_file_atomically(path, write_graph_text(graph, folder_of_output(path)));
}

}  // namespace locograph
