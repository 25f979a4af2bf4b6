#include <locograph/robots/capsule_surface.h>
#include <locograph/robots/fit_cache.h>
#include <locograph/robots/mesh_fit.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

namespace locograph {
namespace {

using Points = std::vector<Eigen::Vector3d>;
/// From, to.
using Segment = Eigen::Matrix<double, 6, 1>;

/// Signed distance to the mesh at the nodes of a grid, linear between them: what the search looks
/// at, thousands of times for each capsule.
class CoarseField {
 public:
  explicit CoarseField(const TriangleTree& mesh) : box_(mesh.bounds()) {
    constexpr double kNodes = 6000.0;
    const double diagonal = std::max(box_.diagonal().norm(), 1e-9);
    const Eigen::Vector3d pad = Eigen::Vector3d::Constant(0.1 * diagonal);
    box_ = Eigen::AlignedBox3d(box_.min() - pad, box_.max() + pad);
    spacing_ = std::cbrt(box_.volume() / kNodes);
    for (int k = 0; k < 3; ++k) {
      size_[k] = 2 + static_cast<int>(box_.sizes()[k] / spacing_);
    }
    fill(mesh);
  }

  double outside(const Eigen::Vector3d& point) const {
    return std::max(0.0, signed_distance(point));
  }

  /// Distance of a point outside the mesh if it is more than `most`, else anything up to that. The
  /// mesh is asked only for what the grid does not know.
  double exact_outside(const TriangleTree& mesh, const Eigen::Vector3d& point, double most) const {
    const double coarse = signed_distance(point), error = 2.0 * spacing_;
    if (coarse < -error || coarse + error <= most) return 0.0;
    const double exact = mesh.distance(point);
    if (exact <= most || coarse > error) return exact;
    return std::abs(mesh.winding_number(point)) > 0.5 ? 0.0 : exact;
  }

  const Points& inside() const { return inside_; }  ///< the nodes inside the mesh

 private:
  double signed_distance(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d inside = point.cwiseMax(box_.min()).cwiseMin(box_.max());
    const Eigen::Vector3d at = (inside - box_.min()) / spacing_;
    const Eigen::Vector3i cell =
        at.cast<int>().cwiseMax(0).cwiseMin(size_ - Eigen::Vector3i::Constant(2));
    const Eigen::Vector3d f = at - cell.cast<double>();
    const float* v = &values_[index(cell.x(), cell.y(), cell.z())];
    const std::size_t y = static_cast<std::size_t>(size_.x());
    const std::size_t z = y * static_cast<std::size_t>(size_.y());
    const auto along_x = [&](std::size_t i) { return v[i] + f.x() * (v[i + 1] - v[i]); };
    const auto along_y = [&](std::size_t i) {
      return along_x(i) + f.y() * (along_x(i + y) - along_x(i));
    };
    const double value = along_y(0) + f.z() * (along_y(z) - along_y(0));
    return value + (point - inside).norm();
  }

  std::size_t index(int x, int y, int z) const {
    return static_cast<std::size_t>((z * size_.y() + y) * size_.x() + x);
  }

  /// Along a row, distances change by no more than the spacing.
  void fill(const TriangleTree& mesh) {
    values_.resize(static_cast<std::size_t>(size_.prod()));
    for (int z = 0; z < size_.z(); ++z) {
      for (int y = 0; y < size_.y(); ++y) {
        double last = std::numeric_limits<double>::infinity();
        for (int x = 0; x < size_.x(); ++x) {
          const Eigen::Vector3d node = box_.min() + spacing_ * Eigen::Vector3d(x, y, z);
          const bool is_inside =
              mesh.bounds().contains(node) && std::abs(mesh.winding_number(node)) > 0.5;
          last = mesh.distance(node, (last + spacing_) * kInflation);
          values_[index(x, y, z)] = static_cast<float>(is_inside ? -last : last);
          if (is_inside) inside_.push_back(node);
        }
      }
    }
  }

  Eigen::AlignedBox3d box_;
  double spacing_ = 0.0;
  Eigen::Vector3i size_ = Eigen::Vector3i::Constant(2);
  std::vector<float> values_;
  Points inside_;
};

/// At most kMostSamples points, by coordinate.
constexpr int kMostSamples = 1024;
using Samples = Eigen::Array<double, Eigen::Dynamic, 3, Eigen::ColMajor, kMostSamples, 3>;

/// At most `most` points, evenly taken, and a quarter as many of those inside.
Samples samples(const Points& corners, const Points& inside, std::size_t most) {
  const std::size_t step = 1 + corners.size() / most;
  const std::size_t inside_step = 1 + inside.size() / (most / 4);
  Samples result(static_cast<Eigen::Index>((corners.size() + step - 1) / step +
                                           (inside.size() + inside_step - 1) / inside_step),
                 3);
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < corners.size(); i += step) result.row(row++) = corners[i];
  for (std::size_t i = 0; i < inside.size(); i += inside_step) result.row(row++) = inside[i];
  return result;
}

Capsule capsule_around(const Samples& points, const Segment& axis) {
  using Column = Eigen::Array<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostSamples, 1>;
  const Eigen::Vector3d from = axis.head<3>(), along = axis.tail<3>() - from;
  const double squared = along.squaredNorm();
  Column t = Column::Zero(points.rows());
  if (squared > 0.0) {
    const Eigen::Vector3d unit = along / squared;
    t = ((points.col(0) - from.x()) * unit.x() + (points.col(1) - from.y()) * unit.y() +
         (points.col(2) - from.z()) * unit.z())
            .max(0.0)
            .min(1.0);
  }
  const double farthest = ((points.col(0) - from.x() - t * along.x()).square() +
                           (points.col(1) - from.y() - t * along.y()).square() +
                           (points.col(2) - from.z() - t * along.z()).square())
                              .maxCoeff();
  return {from, axis.tail<3>(), std::sqrt(farthest)};
}

/// Part of the mesh: what is left of its triangles, and points inside.
struct Piece {
  Points corners;         // of all polygons
  std::vector<int> ends;  // of each polygon among the corners
  Points inside;
  std::vector<Eigen::Matrix3d> frames;  // principal axes and those of the mesh, as columns
  Capsule capsule{};
  double overshoot = 0.0;
};

/// The eigenvectors of the second moment of the polygons' areas (of the corners where they have
/// none).
Eigen::Matrix3d principal_axes(const Piece& piece) {
  constexpr double kNoArea = 1e-15;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  double total = 0.0;
  const Eigen::Vector3d origin = piece.corners[0];
  std::size_t begin = 0;
  for (const int polygon_end : piece.ends) {
    const std::size_t end = static_cast<std::size_t>(polygon_end);
    for (std::size_t i = begin + 2; i < end; ++i) {
      const Eigen::Vector3d a = piece.corners[begin] - origin, b = piece.corners[i - 1] - origin,
                            c = piece.corners[i] - origin, sum = a + b + c;
      const double area = (b - a).cross(c - a).norm() + kNoArea;
      mean += area / 3.0 * sum;
      moment += area / 12.0 *
                (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
      total += area;
    }
    begin = end;
  }
  if (!(total > 0.0)) return Eigen::Matrix3d::Identity();
  mean /= total;
  moment = moment / total - mean * mean.transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moment).eigenvectors();
}

class Fit {
 public:
  Fit(const TriangleTree& mesh, const MeshFitOptions& options)
      : mesh_(mesh), options_(options), field_(mesh) {}

  std::vector<Capsule> run() const {
    Piece whole;
    whole.corners = mesh_.corners();
    for (int end = 3; end <= static_cast<int>(whole.corners.size()); end += 3) {
      whole.ends.push_back(end);
    }
    whole.inside = field_.inside();
    whole = finish(std::move(whole));
    Cover best = cover(whole, false);
    if (best.overshoot <= options_.max_overshoot_m || !options_.spheres) return best.capsules;
    Cover halved = cover(whole, true);
    return (halved.overshoot < best.overshoot ? halved : best).capsules;
  }

 private:
  struct Cover {
    std::vector<Capsule> capsules;
    double overshoot = std::numeric_limits<double>::infinity();
  };

  /// Cuts the worst piece again and again where it helps most, or, what gives worse capsules but
  /// sometimes better spheres, in the middle of its greatest extent.
  Cover cover(const Piece& whole, bool in_the_middle) const {
    Cover best;
    std::vector<Piece> pieces{whole};
    while (true) {
      const auto worst = std::max_element(
          pieces.begin(), pieces.end(),
          [](const Piece& a, const Piece& b) { return a.overshoot < b.overshoot; });
      if (worst->overshoot < best.overshoot) {
        best.overshoot = worst->overshoot;
        best.capsules.clear();
        for (const Piece& piece : pieces) best.capsules.push_back(piece.capsule);
      }
      if (worst->overshoot <= options_.max_overshoot_m) break;
      if (static_cast<int>(pieces.size()) >= options_.max_shapes) break;
      std::optional<std::pair<Piece, Piece>> halves =
          in_the_middle ? middle_cut(*worst) : best_cut(*worst);
      if (!halves) break;
      *worst = finish(std::move(halves->first));
      pieces.push_back(finish(std::move(halves->second)));
    }
    return best;
  }

  /// The worst of the capsule's surface, and a little of the mean, which tells apart what is
  /// equally bad at its worst.
  double coarse_overshoot(const Samples& points, const Segment& axis) const {
    double worst = 0.0, sum = 0.0;
    int count = 0;
    visit_surface<48>(capsule_around(points, axis), [&](const Eigen::Vector3d& point) {
      const double value = field_.outside(point);
      worst = std::max(worst, value);
      sum += value;
      ++count;
    });
    return worst + 0.1 * sum / count;
  }

  double exact_overshoot(const Capsule& capsule) const {
    double worst = 0.0;
    visit_surface<192>(capsule, [&](const Eigen::Vector3d& point) {
      worst = std::max(worst, field_.exact_outside(mesh_, point, worst));
    });
    return worst;
  }

  /// The best of some capsules along the piece's axes and the sphere in its middle.
  std::pair<Segment, double> first_guess(const Piece& piece, const Samples& points) const {
    Segment best = Segment::Zero();
    double least = std::numeric_limits<double>::infinity();
    for (const Eigen::Matrix3d& frame : piece.frames) {
      Eigen::AlignedBox3d box;
      for (Eigen::Index i = 0; i < points.rows(); ++i) {
        box.extend(frame.transpose() * points.row(i).matrix().transpose());
      }
      const Eigen::Vector3d middle = frame * box.center(), half = 0.5 * box.sizes();
      for (int k = 0; k < (options_.spheres ? 1 : 3); ++k) {
        const double across = std::hypot(half[(k + 1) % 3], half[(k + 2) % 3]);
        for (const double inset : {0.5, std::sqrt(0.5), std::numeric_limits<double>::infinity()}) {
          const bool sphere = !(half[k] > inset * across);
          if (sphere && k > 0) continue;
          if (options_.spheres && !sphere) continue;
          const Eigen::Vector3d along =
              sphere ? Eigen::Vector3d::Zero()
                     : Eigen::Vector3d((half[k] - inset * across) * frame.col(k));
          Segment axis;
          axis << middle - along, middle + along;
          const double value = coarse_overshoot(points, axis);
          if (value < least) {
            least = value;
            best = axis;
          }
        }
      }
    }
    return {best, least};
  }

  /// Pattern search over the end points.
  std::pair<Segment, double> improved(const Samples& points, Segment axis, double value,
                                      int most_tries) const {
    const double diagonal =
        (points.colwise().maxCoeff() - points.colwise().minCoeff()).matrix().norm();
    int tries = 0;
    for (double step = 0.1 * diagonal; step > 0.004 * diagonal; step *= 0.5) {
      for (bool better = true; better && tries < most_tries;) {
        better = false;
        for (int k = 0; k < (options_.spheres ? 3 : 6); ++k) {
          for (const double sign : {-1.0, 1.0}) {
            Segment other = axis;
            other[k] += sign * step;
            if (options_.spheres) other[k + 3] = other[k];
            ++tries;
            const double other_value = coarse_overshoot(points, other);
            if (other_value >= value) continue;
            value = other_value;
            axis = other;
            better = true;
            break;
          }
        }
      }
    }
    return {axis, value};
  }

  void find_axes(Piece& piece) const {
    piece.frames.push_back(Eigen::Matrix3d::Identity());
    piece.frames.push_back(principal_axes(piece));
  }

  /// The capsule around the whole piece: the search's, or the first guess where the grid misled it.
  Piece finish(Piece piece) const {
    if (piece.frames.empty()) find_axes(piece);
    const Samples points = samples(piece.corners, piece.inside, 600);
    const auto [guess, value] = first_guess(piece, points);
    piece.overshoot = std::numeric_limits<double>::infinity();
    for (const Segment& axis : {guess, improved(points, guess, value, 200).first}) {
      const Capsule capsule = around(piece, axis);
      const double exact = exact_overshoot(capsule);
      if (exact >= piece.overshoot) continue;
      piece.overshoot = exact;
      piece.capsule = capsule;
    }
    return piece;
  }

  static Capsule around(const Piece& piece, const Segment& axis) {
    Capsule capsule{axis.head<3>(), axis.tail<3>(), 0.0};
    for (const Points* points : {&piece.corners, &piece.inside}) {
      for (const Eigen::Vector3d& point : *points) {
        capsule.radius = std::max(capsule.radius, distance_to_axis(capsule, point) * kInflation);
      }
    }
    return capsule;
  }

  static std::pair<Piece, Piece> cut(const Piece& piece, const Eigen::Vector3d& normal,
                                     double offset) {
    std::pair<Piece, Piece> halves;
    Piece &below = halves.first, &above = halves.second;
    std::size_t begin = 0;
    for (const int polygon_end : piece.ends) {
      const std::size_t end = static_cast<std::size_t>(polygon_end);
      for (std::size_t i = begin; i < end; ++i) {
        const Eigen::Vector3d& a = piece.corners[i];
        const Eigen::Vector3d& b = piece.corners[i + 1 < end ? i + 1 : begin];
        const double from = normal.dot(a) - offset, to = normal.dot(b) - offset;
        (from <= 0.0 ? below : above).corners.push_back(a);
        if ((from <= 0.0) == (to <= 0.0)) continue;
        const Eigen::Vector3d between = a + from / (from - to) * (b - a);
        below.corners.push_back(between);
        above.corners.push_back(between);
      }
      for (Piece* half : {&below, &above}) {
        const int count = static_cast<int>(half->corners.size());
        if (count > (half->ends.empty() ? 0 : half->ends.back())) half->ends.push_back(count);
      }
      begin = end;
    }
    for (const Eigen::Vector3d& point : piece.inside) {
      (normal.dot(point) <= offset ? below : above).inside.push_back(point);
    }
    return halves;
  }

  std::optional<std::pair<Piece, Piece>> middle_cut(const Piece& piece) const {
    const Eigen::Matrix3d& frame = piece.frames.back();
    const Eigen::AlignedBox3d box = extent(piece, frame);
    int axis = 0;
    box.sizes().maxCoeff(&axis);
    std::pair<Piece, Piece> halves = cut(piece, frame.col(axis), box.center()[axis]);
    if (halves.first.corners.empty() || halves.second.corners.empty()) return {};
    // Axes of its own would turn with every cut of a cube.
    halves.first.frames = halves.second.frames = piece.frames;
    return halves;
  }

  static Eigen::AlignedBox3d extent(const Piece& piece, const Eigen::Matrix3d& frame) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& corner : piece.corners) box.extend(frame.transpose() * corner);
    return box;
  }

  std::optional<std::pair<Piece, Piece>> best_cut(const Piece& piece) const {
    std::optional<std::pair<Piece, Piece>> best;
    double least = std::numeric_limits<double>::infinity();
    for (const Eigen::Matrix3d& frame : piece.frames) {
      const Eigen::AlignedBox3d box = extent(piece, frame);
      for (int k = 0; k < 3; ++k) {
        for (const double fraction : {1.0 / 6, 1.0 / 3, 0.5, 2.0 / 3, 5.0 / 6}) {
          std::pair<Piece, Piece> halves =
              cut(piece, frame.col(k), box.min()[k] + fraction * box.sizes()[k]);
          double worst = 0.0, sum = 0.0;
          for (Piece* half : {&halves.first, &halves.second}) {
            if (half->corners.empty()) {
              worst = std::numeric_limits<double>::infinity();
              break;
            }
            find_axes(*half);
            const Samples points = samples(half->corners, half->inside, 150);
            const auto [guess, first] = first_guess(*half, points);
            const double value = improved(points, guess, first, 20).second;
            worst = std::max(worst, value);
            sum += value;
          }
          const double value = worst + 0.25 * sum;
          if (value < least) {
            least = value;
            best = std::move(halves);
          }
        }
      }
    }
    return best;
  }

  const TriangleTree& mesh_;
  MeshFitOptions options_;
  CoarseField field_;
};

/// The newest fits: a robot that is loaded again asks for those of the same meshes.
class Memory {
 public:
  std::optional<std::vector<Capsule>> find(const Points& corners, const MeshFitOptions& options) {
    const std::scoped_lock lock(mutex_);
    for (const Entry& entry : entries_) {
      if (entry.options == options && entry.corners == corners) return entry.capsules;
    }
    return std::nullopt;
  }
  void add(const Points& corners, const MeshFitOptions& options,
           const std::vector<Capsule>& capsules) {
    const std::scoped_lock lock(mutex_);
    if (entries_.size() == kMost) entries_.pop_front();
    entries_.push_back({corners, options, capsules});
  }

 private:
  static constexpr std::size_t kMost = 64;
  struct Entry {
    Points corners;
    MeshFitOptions options;
    std::vector<Capsule> capsules;
  };
  std::mutex mutex_;
  std::deque<Entry> entries_;
};

Memory& memory() {
  static Memory instance;
  return instance;
}

}  // namespace

std::vector<Capsule> fit_capsules(const TriangleTree& mesh, const MeshFitOptions& options) {
  if (auto known = memory().find(mesh.corners(), options)) return *std::move(known);
  std::optional<std::vector<Capsule>> capsules = cached_fit(mesh.corners(), options);
  if (!capsules) {
    capsules = Fit(mesh, options).run();
    cache_fit(mesh.corners(), options, *capsules);
  }
  memory().add(mesh.corners(), options, *capsules);
  return *std::move(capsules);
}

}  // namespace locograph
