#pragma once
/// Random lines of a graph file for any registered type, its fields found out by trying: so that a
/// type is tested as soon as it is registered.
///
///     RandomLines lines(standard_types(), 1);
///     std::string text = lines.parameters() + lines.edge("EDGE_SE2", 0);

#include <locograph/core/graph_file.h>

#include <Eigen/Core>
#include <cstdio>
#include <map>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace locograph::test {

class RandomLines {
 public:
  RandomLines(TypeRegistry types, unsigned seed) : types_(std::move(types)), engine_(seed) {
    int number = 0;
    for (const std::string& tag : types_.tags()) {
      if (types_.parameter_type(tag) == nullptr) continue;
      parameters_ += found_line(tag + " " + std::to_string(number++)) + "\n";
    }
    parameter_count_ = number;
  }

  /// One line for each type of parameter, numbered from 0.
  const std::string& parameters() const { return parameters_; }

  std::string vertex(const std::string& tag, int id) {
    const std::string head = tag + " " + std::to_string(id);
    const auto known = vertex_fields_.find(tag);
    if (known != vertex_fields_.end()) return with_shape(head, known->second);
    for (int integers = 0; integers <= 2; ++integers) {
      for (int fields = 1; fields < 64; ++fields) {
        const VertexShape shape{fields, integers};
        const std::string line = with_shape(head, shape);
        if (accepted(line)) {
          vertex_fields_[tag] = shape;
          return line;
        }
      }
    }
    throw std::runtime_error("no fields found for " + tag);
  }

  /// An edge on vertices of its own, with ids from first_id on: the lines of the vertices and,
  /// last, that of the edge.
  std::vector<std::string> edge(const std::string& tag, int first_id) {
    const std::unique_ptr<EdgePool> pool = (*types_.edge_type(tag))();
    const int arity = pool->arity() >= 0 ? pool->arity() : kRunTimeArity;
    std::vector<std::string> lines;
    std::string head = tag, vertices;
    for (int i = 0; i < arity; ++i) {
      // Null where any type of vertex will do.
      const std::unique_ptr<VertexPool> slot = pool->make_slot_pool(i);
      lines.push_back(vertex(slot ? slot->tag() : "VERTEX_XY", first_id + i));
      vertices += lines.back() + "\n";
      head += " " + std::to_string(first_id + i);
    }
    const bool run_time = pool->arity() < 0;
    lines.push_back(edge_line(tag, run_time ? head + " ||" : head, vertices, run_time));
    return lines;
  }

  /// Whether a strict reader takes these lines.
  bool accepted(const std::string& lines) const {
    try {
      read_graph_text(parameters_ + lines, "probe", {}, types_);
      return true;
    } catch (const Error&) {
      return false;
    }
  }
  const TypeRegistry& types() const { return types_; }

 private:
  static constexpr int kRunTimeArity = 4;

  struct VertexShape {
    int numbers = 0;
    int integers = 0;  ///< that come last
  };
  struct EdgeShape {
    int count = 0;                ///< written where the arity is known at run time
    std::vector<int> parameters;  ///< numbers that come first
    int measurement = 0;
    int dimension = 0;
  };

  std::string text(double value) const {
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, " %.17g", value);
    return buffer;
  }
  /// Never whole, so that a field for an integer refuses it. Now and then one is ±π, where headings
  /// wrap; one only, so that points do not coincide.
  std::string numbers(int count, bool with_wraps) {
    std::uniform_real_distribution<double> uniform(-3.1, 3.1);
    std::string all;
    const int wrapping = with_wraps ? static_cast<int>(engine_() % (2 * count)) : count;
    for (int i = 0; i < count; ++i) {
      const unsigned kind = i == wrapping ? engine_() % 4 : 9;
      const double pi = kind % 2 == 0 ? std::numbers::pi : -std::numbers::pi;
      all += text(kind < 2 ? pi : kind < 4 ? pi * (1.0 - 1e-9) : uniform(engine_));
    }
    return all;
  }
  std::string information(int dimension) {
    std::normal_distribution<double> normal;
    Eigen::MatrixXd a(dimension, dimension);
    for (Eigen::Index i = 0; i < a.size(); ++i) a(i) = normal(engine_);
    const Eigen::MatrixXd m = a * a.transpose() + Eigen::MatrixXd::Identity(dimension, dimension);
    std::string all;
    for (int r = 0; r < dimension; ++r) {
      for (int c = r; c < dimension; ++c) all += text(m(r, c));
    }
    return all;
  }
  template <class Number>
  static void append(std::string& line, Number number) {
    line += ' ';
    line += std::to_string(number);
  }
  std::string with_shape(const std::string& head, const VertexShape& shape) {
    std::string line = head + numbers(shape.numbers, true);
    for (int i = 0; i < shape.integers; ++i) append(line, engine_() % 100);
    return line;
  }
  std::string with_shape(const std::string& head, const EdgeShape& shape, bool run_time) {
    std::string line = head;
    if (run_time) append(line, shape.count);
    for (const int p : shape.parameters) append(line, p);
    return line + numbers(shape.measurement, false) + information(shape.dimension);
  }

  std::string found_line(const std::string& head) {
    for (int fields = 0; fields < 64; ++fields) {
      const std::string line = head + numbers(fields, false);
      if (accepted(line)) return line;
    }
    throw std::runtime_error("no fields found for " + head);
  }

  std::string edge_line(const std::string& tag, const std::string& head,
                        const std::string& vertices, bool run_time) {
    const auto known = edge_shape_.find(tag);
    if (known != edge_shape_.end()) return with_shape(head, known->second, run_time);
    std::vector<std::vector<int>> choices{{}};
    for (int a = 0; a < parameter_count_; ++a) {
      choices.push_back({a});
      for (int b = 0; b < parameter_count_; ++b) choices.push_back({a, b});
    }
    for (const std::vector<int>& parameters : choices) {
      for (int dimension = 1; dimension <= 9; ++dimension) {
        for (int measurement = 0; measurement <= 16; ++measurement) {
          // A file may count the rows of the error or, with one leading vertex, the others.
          for (const int count : {dimension, kRunTimeArity - 1}) {
            const EdgeShape shape{count, parameters, measurement, dimension};
            const std::string line = with_shape(head, shape, run_time);
            if (!accepted(vertices + line)) continue;
            const Graph graph = read_graph_text(parameters_ + vertices + line, "probe", {}, types_);
            if (graph.edge_pools()[0]->dimension(0) != dimension) continue;
            edge_shape_[tag] = shape;
            return line;
          }
        }
      }
    }
    throw std::runtime_error("no fields found for " + tag);
  }

  TypeRegistry types_;
  std::mt19937 engine_;
  std::string parameters_;
  int parameter_count_ = 0;
  std::map<std::string, VertexShape> vertex_fields_;
  std::map<std::string, EdgeShape> edge_shape_;
};

}  // namespace locograph::test
