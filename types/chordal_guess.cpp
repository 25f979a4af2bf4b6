#include <locograph/core/initial_guess.h>
#include <locograph/types/chordal_guess.h>
#include <locograph/types/parts.h>
#include <locograph/types/slam2d/edges.h>
#include <locograph/types/slam3d/edges.h>
#include <locograph/types/slam3d/priors.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <numeric>

namespace locograph {
namespace {

template <int N>
using Matrix = Eigen::Matrix<double, N, N>;
template <int N>
using Vector = Eigen::Matrix<double, N, 1>;

/// Pose b seen from pose a: R_b = R_a Z and t_b + R_b·lever = t_a + R_a·in_a.
template <int N>
struct Relation {
  int a, b;  ///< vertex slots
  Matrix<N> rotation;
  Vector<N> in_a, lever;
  double rotation_weight;
  Matrix<N> translation_weight;  ///< in the axes of a
};

/// Pose a itself: R_a = Z and t_a + R_a·lever = position.
template <int N>
struct Anchor {
  int a;
  Matrix<N> rotation;
  Vector<N> position, lever;
  double rotation_weight;
  Matrix<N> translation_weight;  ///< in the axes of the world

  bool holds() const { return rotation_weight > 0.0 && translation_weight.trace() > 0.0; }
};

/// The two kinds of pose, alike for the templates below.
template <int N>
struct Space;

template <>
struct Space<2> {
  using Vertex = VertexSE2;
  static Matrix<2> rotation(const SE2<double>& pose) {
    return Eigen::Rotation2Dd(pose.angle()).toRotationMatrix();
  }
  static SE2<double> pose(const Matrix<2>& rotation, const Vector<2>& translation) {
    return {translation, std::atan2(rotation(1, 0), rotation(0, 0))};
  }
  static double rotation_weight(const Eigen::Matrix3d& information) { return information(2, 2); }
};

template <>
struct Space<3> {
  using Vertex = VertexSE3;
  static Matrix<3> rotation(const SE3<double>& pose) { return pose.rotation().toRotationMatrix(); }
  static SE3<double> pose(const Matrix<3>& rotation, const Vector<3>& translation) {
    return {translation, Eigen::Quaterniond(rotation).normalized()};
  }
  static double rotation_weight(const Eigen::Matrix<double, 6, 6>& information) {
    return information.diagonal().tail<3>().mean();
  }
};

/// Z⁻¹ ((A·first)⁻¹ (B·second)) is what is measured to be the identity.
template <int N, class E, class Pose>
Relation<N> relation(const E& edge, const Pose& first, const Pose& second) {
  const Pose a_from_z = first * edge.measurement;
  const Matrix<N> axes = Space<N>::rotation(a_from_z);
  return {edge.vertices[0],
          edge.vertices[1],
          axes * Space<N>::rotation(second).transpose(),
          a_from_z.translation(),
          second.translation(),
          Space<N>::rotation_weight(edge.information),
          axes * edge.information.template topLeftCorner<N, N>() * axes.transpose()};
}

/// Z⁻¹ (A·offset) is what is measured to be the identity.
template <int N, class E, class Pose>
Anchor<N> anchor(const E& edge, const Pose& offset) {
  const Matrix<N> axes = Space<N>::rotation(edge.measurement);
  return {edge.vertices[0],
          axes * Space<N>::rotation(offset).transpose(),
          edge.measurement.translation(),
          offset.translation(),
          Space<N>::rotation_weight(edge.information),
          axes * edge.information.template topLeftCorner<N, N>() * axes.transpose()};
}

template <int N>
class Relaxation {
 public:
  Relaxation(Graph& graph, std::vector<Relation<N>> relations, std::vector<Anchor<N>> anchors)
      : graph_(graph),
        relations_(std::move(relations)),
        anchors_(std::move(anchors)),
        parts_(graph.vertex_slots()),
        rotation_(graph.vertex_slots()),
        translation_(graph.vertex_slots()),
        unknown_(graph.vertex_slots(), -1) {}

  /// Marks the vertices it gave a value. False when a system could not be solved.
  bool solve(LinearSolver& solver, std::vector<bool>& known) {
    std::erase_if(relations_, [](const Relation<N>& r) { return !(r.rotation_weight > 0.0); });
    choose_unknowns();
    if (!slots_.empty()) {
      build_pattern();
      solver.analyse(pattern_);
      if (!solve_rotations(solver) || !solve_translations(solver)) return false;
      align_to_positions();
    }
    for (const int slot : slots_) {
      Space<N>::Vertex::store(Space<N>::pose(rotation_[slot], translation_[slot]),
                              graph_.state(slot));
      known[slot] = true;
    }
    for (const int slot : held_) {
      // One that was moved with its part.
      if (!graph_.vertex_record(slot).fixed) {
        Space<N>::Vertex::store(Space<N>::pose(rotation_[slot], translation_[slot]),
                                graph_.state(slot));
      }
      known[slot] = true;
    }
    return true;
  }

 private:
  void choose_unknowns() {
    const int n = graph_.vertex_slots();
    std::vector<bool> related(n, false), held(n, false);
    for (const Relation<N>& r : relations_) {
      parts_.join(r.a, r.b);
      related[r.a] = related[r.b] = true;
    }
    for (int v = 0; v < n; ++v) {
      if (is_pose(v) && graph_.vertex_record(v).fixed) held[parts_.first(v)] = true;
    }
    for (const Anchor<N>& a : anchors_) {
      if (!a.holds()) continue;
      held[parts_.first(a.a)] = true;
      related[a.a] = true;
    }
    for (int v = 0; v < n; ++v) {
      if (!is_pose(v) || !related[v]) continue;
      const auto pose = Space<N>::Vertex::view(graph_.state(v));
      rotation_[v] = Space<N>::rotation(pose);
      translation_[v] = pose.translation();
      if (graph_.vertex_record(v).fixed || (parts_.first(v) == v && !held[v])) {
        held_.push_back(v);
      } else {
        unknown_[v] = static_cast<int>(slots_.size());
        slots_.push_back(v);
      }
    }
    // Priors of a position alone cannot be used before the part's rotation is known.
    for (const Anchor<N>& a : anchors_) {
      if (!held[parts_.first(a.a)]) floating_.push_back(a);
    }
    std::erase_if(anchors_, [&](const Anchor<N>& a) {
      return !held[parts_.first(a.a)] || unknown_[a.a] < 0;
    });
  }

  bool is_pose(int slot) const {
    return graph_.vertex_alive(slot) &&
           graph_.vertex_pools()[graph_.vertex_record(slot).pool]->type() ==
               typeid(typename Space<N>::Vertex);
  }

  void build_pattern() {
    const int n = static_cast<int>(slots_.size());
    std::vector<std::pair<int, int>> blocks;  // column, row
    for (int v = 0; v < n; ++v) blocks.emplace_back(v, v);
    for (const Relation<N>& r : relations_) {
      const int a = unknown_[r.a], b = unknown_[r.b];
      if (a >= 0 && b >= 0) blocks.emplace_back(std::max(a, b), std::min(a, b));
    }
    std::sort(blocks.begin(), blocks.end());
    blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
    pattern_.kept = n;
    pattern_.dimension.assign(n, N);
    pattern_.column_begin.assign(n + 1, 0);
    pattern_.scalar_begin.resize(n + 1);
    for (int v = 0; v <= n; ++v) pattern_.scalar_begin[v] = N * v;
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      pattern_.row.push_back(blocks[k].second);
      pattern_.value_offset.push_back(static_cast<std::int64_t>(k) * N * N);
      ++pattern_.column_begin[blocks[k].first + 1];
    }
    pattern_.value_offset.push_back(static_cast<std::int64_t>(blocks.size()) * N * N);
    std::partial_sum(pattern_.column_begin.begin(), pattern_.column_begin.end(),
                     pattern_.column_begin.begin());
  }

  Eigen::Map<Matrix<N>> block(int row, int column) {
    return Eigen::Map<Matrix<N>>(values_.data() +
                                 pattern_.value_offset[pattern_.block_of(row, column)]);
  }
  /// Adds `value` at (a, b), a ≠ b, or its transpose at (b, a): whichever is stored.
  void add(int a, int b, const Matrix<N>& value) {
    if (a < b) {
      block(a, b) += value;
    } else {
      block(b, a) += value.transpose();
    }
  }

  void clear(int right_hand_sides) {
    values_.assign(pattern_.values(), 0.0);
    right_.setZero(N * static_cast<Eigen::Index>(slots_.size()), right_hand_sides);
  }

  /// Solves in place. Directions that nothing measures get a little damping.
  bool factorise_and_solve(LinearSolver& solver) {
    double largest = 0.0;
    for (int v = 0; v < pattern_.size(); ++v) {
      largest = std::max(largest, block(v, v).diagonal().maxCoeff());
    }
    if (!std::isfinite(largest) || !right_.allFinite()) return false;
    std::vector<double> damping(pattern_.scalar_size(), 0.0);
    if (!solver.factorise(values_.data(), damping.data())) {
      std::fill(damping.begin(), damping.end(), 1e-12 * largest);
      if (!solver.factorise(values_.data(), damping.data())) return false;
    }
    for (int c = 0; c < right_.cols(); ++c) {
      solver.solve(right_.col(c).data(), right_.col(c).data());
    }
    return right_.allFinite();
  }

  /// Row i of a rotation, as a column x: x_b = Zᵀ x_a, the same system for every i.
  bool solve_rotations(LinearSolver& solver) {
    clear(N);
    for (const Relation<N>& r : relations_) {
      const int a = unknown_[r.a], b = unknown_[r.b];
      const double w = r.rotation_weight;
      if (a >= 0) block(a, a).diagonal().array() += w;
      if (b >= 0) block(b, b).diagonal().array() += w;
      if (a >= 0 && b >= 0) {
        add(a, b, -w * r.rotation);
      } else if (a >= 0) {
        right_.template middleRows<N>(N * a) += w * r.rotation * rotation_[r.b].transpose();
      } else if (b >= 0) {
        right_.template middleRows<N>(N * b) +=
            w * r.rotation.transpose() * rotation_[r.a].transpose();
      }
    }
    for (const Anchor<N>& anchor : anchors_) {
      const int a = unknown_[anchor.a];
      block(a, a).diagonal().array() += anchor.rotation_weight;
      right_.template middleRows<N>(N * a) += anchor.rotation_weight * anchor.rotation.transpose();
    }
    if (!factorise_and_solve(solver)) return false;
    for (const int slot : slots_) {
      rotation_[slot] =
          nearest_rotation(right_.template middleRows<N>(N * unknown_[slot]).transpose());
    }
    return true;
  }

  static Matrix<N> nearest_rotation(const Matrix<N>& matrix) {
    const Eigen::JacobiSVD<Matrix<N>> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Vector<N> sign = Vector<N>::Ones();
    sign[N - 1] = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
    return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  }

  bool solve_translations(LinearSolver& solver) {
    clear(1);
    for (const Relation<N>& r : relations_) {
      const int a = unknown_[r.a], b = unknown_[r.b];
      const Matrix<N> w = rotation_[r.a] * r.translation_weight * rotation_[r.a].transpose();
      Vector<N> between = rotation_[r.a] * r.in_a - rotation_[r.b] * r.lever;  // t_b − t_a
      if (a < 0) between += translation_[r.a];
      if (b < 0) between -= translation_[r.b];
      if (a >= 0) {
        block(a, a) += w;
        right_.template middleRows<N>(N * a) -= w * between;
      }
      if (b >= 0) {
        block(b, b) += w;
        right_.template middleRows<N>(N * b) += w * between;
      }
      if (a >= 0 && b >= 0) add(a, b, -w);
    }
    for (const Anchor<N>& anchor : anchors_) {
      const int a = unknown_[anchor.a];
      block(a, a) += anchor.translation_weight;
      right_.template middleRows<N>(N * a) +=
          anchor.translation_weight * (anchor.position - rotation_[anchor.a] * anchor.lever);
    }
    if (!factorise_and_solve(solver)) return false;
    for (const int slot : slots_) {
      translation_[slot] = right_.template middleRows<N>(N * unknown_[slot]);
    }
    return true;
  }

  /// Where the measured point of pose a stands.
  Vector<N> lever_end(const Anchor<N>& anchor) const {
    return translation_[anchor.a] + rotation_[anchor.a] * anchor.lever;
  }

  /// Moves each part that only its first vertex held onto the positions measured in it.
  void align_to_positions() {
    for (const int first : held_) {
      if (graph_.vertex_record(first).fixed) continue;
      std::vector<const Anchor<N>*> own;
      for (const Anchor<N>& a : floating_) {
        if (parts_.first(a.a) == first && a.translation_weight.trace() > 0.0) own.push_back(&a);
      }
      if (own.size() < N) continue;
      // Umeyama 1991, eq. 39 to 41, without scale.
      const double share = 1.0 / static_cast<double>(own.size());
      Vector<N> from = Vector<N>::Zero(), to = Vector<N>::Zero();
      for (const Anchor<N>* a : own) {
        from += share * lever_end(*a);
        to += share * a->position;
      }
      Matrix<N> moments = Matrix<N>::Zero();
      for (const Anchor<N>* a : own) {
        moments += (a->position - to) * (lever_end(*a) - from).transpose();
      }
      const Matrix<N> turn = nearest_rotation(moments);
      const Vector<N> move = to - turn * from;
      for (int v = first; v < graph_.vertex_slots(); ++v) {
        if (parts_.first(v) != first) continue;
        rotation_[v] = turn * rotation_[v];
        translation_[v] = turn * translation_[v] + move;
      }
    }
  }

  Graph& graph_;
  std::vector<Relation<N>> relations_;
  std::vector<Anchor<N>> anchors_, floating_;
  Parts parts_;
  std::vector<Matrix<N>> rotation_;  ///< by vertex slot, as is translation_
  std::vector<Vector<N>> translation_;
  std::vector<int> unknown_;  ///< block row by vertex slot, -1 for none
  std::vector<int> slots_, held_;
  BlockPattern pattern_;
  std::vector<double> values_;
  Eigen::MatrixXd right_;
};

/// use(edge) for every edge of type E that is not left out.
template <class E, class Use>
void for_each(const Graph& graph, const std::vector<bool>& left_out, Use use) {
  for (int slot = 0; slot < graph.edge_slots(); ++slot) {
    if (!graph.edge_alive(slot) || left_out[slot]) continue;
    const Graph::EdgeRecord& record = graph.edge_record(slot);
    const EdgePool& pool = *graph.edge_pools()[record.pool];
    if (pool.type() == typeid(E)) {
      use(static_cast<const TypedEdgePool<E>&>(pool).edges[record.index]);
    }
  }
}

Relaxation<2> planar(Graph& graph, const std::vector<bool>& left_out) {
  std::vector<Relation<2>> relations;
  std::vector<Anchor<2>> anchors;
  const SE2<double> none;
  for_each<EdgeSE2>(graph, left_out,
                    [&](const EdgeSE2& e) { relations.push_back(relation<2>(e, none, none)); });
  for_each<EdgeSE2Offset>(graph, left_out, [&](const EdgeSE2Offset& e) {
    relations.push_back(relation<2>(e, e.first, e.second));
  });
  for_each<EdgePriorSE2>(graph, left_out,
                         [&](const EdgePriorSE2& e) { anchors.push_back(anchor<2>(e, none)); });
  for_each<EdgePriorSE2XY>(graph, left_out, [&](const EdgePriorSE2XY& e) {
    anchors.push_back({e.vertices[0], Matrix<2>::Identity(), e.measurement, Vector<2>::Zero(), 0.0,
                       e.information});
  });
  return {graph, std::move(relations), std::move(anchors)};
}

Relaxation<3> spatial(Graph& graph, const std::vector<bool>& left_out) {
  std::vector<Relation<3>> relations;
  std::vector<Anchor<3>> anchors;
  const SE3<double> none;
  for_each<EdgeSE3>(graph, left_out,
                    [&](const EdgeSE3& e) { relations.push_back(relation<3>(e, none, none)); });
  for_each<EdgeSE3Offset>(graph, left_out, [&](const EdgeSE3Offset& e) {
    relations.push_back(relation<3>(e, e.first, e.second));
  });
  for_each<EdgeSE3Prior>(graph, left_out,
                         [&](const EdgeSE3Prior& e) { anchors.push_back(anchor<3>(e, e.offset)); });
  return {graph, std::move(relations), std::move(anchors)};
}

}  // namespace

int guess_chordal(Graph& graph, LinearSolver& solver, std::span<const int> left_out) {
  std::vector<bool> known(graph.vertex_slots(), false), out(graph.edge_slots(), false);
  for (const int slot : left_out) out[slot] = true;
  if (!planar(graph, out).solve(solver, known) || !spatial(graph, out).solve(solver, known)) {
    return guess_from_spanning_tree(graph);
  }
  // The walk starts at what is fixed, and now that is what is known.
  std::vector<int> to_free;
  for (int v = 0; v < graph.vertex_slots(); ++v) {
    if (!known[v] || graph.vertex_record(v).fixed) continue;
    graph.set_fixed(v, true);
    to_free.push_back(v);
  }
  const int unreached = guess_from_spanning_tree(graph);
  for (const int v : to_free) graph.set_fixed(v, false);
  return unreached;
}

}  // namespace locograph
