#include <locograph/planners/offline/motion/interpolation.h>
#include <locograph/planners/offline/motion/swing.h>
#include <locograph/robots/contact_kinds.h>

#include <algorithm>
#include <array>

namespace locograph {
namespace {

/// Neighbours are so near that the way between them, closed, is near the straight one.
constexpr double kNear = 0.15;
constexpr int kDeepest = 9;
/// A configuration half-way may make the way longer, by so much of it and a little.
constexpr double kLonger = 2.0, kLongerBy = 0.6;
constexpr int kSmoothings = 4;
constexpr double kHalf = 0.5;
constexpr int kMarch = 8;
/// What lies half-way is no arc: it need not be halved as often.
constexpr int kMarchDepth = 3;
/// Parts of a way that straighter ones replace, where it is so many times as long as straight, and
/// by so much; by ways that are shorter by so much.
constexpr std::array<double, 4> kShares = {0.75, 0.5, 0.3, 0.15};
constexpr double kDetour = 2.0, kLeastDetour = 0.5, kShorter = 0.9;
/// What swings is not smoothed near its places.
constexpr double kKept = 0.2;

/// In the order in which they are tried, those first on which nothing is in the way.
constexpr std::array<ArcOptions, 21> kArcs = {
    {{.height_m = 0.05},
     {.height_m = 0.05, .with_axes = false},
     {.height_m = 0.05, .with_axes = false, .away_m = 0.1},
     {.height_m = 0.05, .away_m = 0.15},
     {.height_m = 0.06, .away_m = 0.1, .climb_first = true},
     {.height_m = 0.06, .away_m = 0.16, .climb_first = true},
     {.height_m = 0.012, .away_m = 0.14, .climb_first = true},
     {.height_m = 0.05, .with_axes = false, .away_m = 0.15},
     {.height_m = 0.05, .with_axes = false, .away_m = 0.2},
     {.height_m = 0.05, .with_axes = false, .away_m = 0.28},
     {.height_m = 0.012, .with_axes = false, .away_m = 0.12},
     {.height_m = 0.06, .with_axes = false, .away_m = 0.1, .climb_first = true},
     {.height_m = 0.06, .with_axes = false, .away_m = 0.16, .climb_first = true},
     {.height_m = 0.012, .with_axes = false, .away_m = 0.14, .climb_first = true},
     {.height_m = 0.012, .with_axes = false, .away_m = 0.22, .climb_first = true},
     {.height_m = 0.06, .with_axes = false, .climb_first = true},
     {.height_m = 0.12, .with_axes = false},
     {.height_m = 0.03, .with_axes = false, .up_m = 0.1},
     {.height_m = 0.02, .with_axes = false, .up_m = 0.2},
     {.height_m = 0.05, .ends_only = true},
     {.height_m = 0.04, .with_axes = false, .ends_only = true}}};
/// Of arcs with something in the way, which a link that turns may pass.
constexpr int kMostBlocked = 3;
constexpr int kLooks = 16;

struct Knot {
  double t;
  Eigen::VectorXd q;
};

class Interpolation : public SegmentPlanner {
 public:
  const std::string& name() const override {
    static const std::string name = "interpolation";
    return name;
  }

 private:
  bool search(SegmentSpace& space, const SegmentOptions& options,
              SegmentPath& path) const override {
    const std::vector<Swing> swings = swings_of(space);
    int& tried = path.statistics.iterations;
    const auto try_arc = [&](const ArcOptions& arc) {
      if (options.termination.ended(tried)) return false;
      ++tried;
      return follow(space, swings, arc, path);
    };
    if (swings.empty()) return try_arc(kArcs.front());
    // Balls and wheels have no axes to turn: they take each arc once.
    const bool turns = std::ranges::any_of(swings, [](const Swing& swing) {
      return contact_kind_entry(swing.contact().effector.kind).holds_normal;
    });
    std::vector<ArcOptions> held, free, blocked;
    for (const ArcOptions& arc : kArcs) {
      const auto on_arc = [&arc](const Swing& swing) { return swing.follows_arc(arc); };
      if (!turns && arc.with_axes) continue;
      (std::ranges::any_of(swings, on_arc) ? held : free).push_back(arc);
    }
    // What is only lifted or only put down is free in between, at first.
    const bool free_first = std::ranges::any_of(swings, [](const Swing& swing) {
      return swing.left == nullptr || swing.reached == nullptr;
    });
    if (free_first && std::ranges::any_of(free, try_arc)) return true;
    for (const ArcOptions& arc : held) {
      if (is_blocked(space, swings, arc)) {
        blocked.push_back(arc);
      } else if (try_arc(arc)) {
        return true;
      }
    }
    // No ball passes by turning.
    path.no_arc = blocked.size() == held.size() && !turns && !free_first;
    if (path.no_arc) {
      path.reason = "what swings has no way past what is between its places";
      return false;
    }
    if (static_cast<int>(blocked.size()) > kMostBlocked) blocked.resize(kMostBlocked);
    if (std::ranges::any_of(blocked, try_arc)) return true;
    return !free_first && std::ranges::any_of(free, try_arc);
  }

  /// The path along an arc into `path`, or why there is none.
  static bool follow(SegmentSpace& space, const std::vector<Swing>& swings, const ArcOptions& arc,
                     SegmentPath& path) {
    const Knot begin{0.0, space.segment().from}, end{1.0, space.segment().to};
    std::vector<Knot> knots = {begin};
    if (!fill(space, swings, arc, knots, end, 0)) {
      path.reason = space.why_not().empty() ? "no short way leads half-way" : space.why_not();
      if (swings.empty() || !march(space, swings, arc, begin, end, knots)) return false;
    }
    shorten(space, swings, arc, knots);
    smooth(space, !swings.empty(), knots);
    for (Knot& knot : knots) path.waypoints.push_back(std::move(knot.q));
    return true;
  }

  /// Something is in the way of a link on its arc, if it turns evenly.
  static bool is_blocked(SegmentSpace& space, const std::vector<Swing>& swings,
                         const ArcOptions& arc) {
    return std::ranges::any_of(swings, [&](const Swing& swing) {
      if (!swing.follows_arc(arc)) return false;
      for (int i = 1; i < kLooks; ++i) {
        const Eigen::Isometry3d pose = swing.pose(static_cast<double>(i) / kLooks, arc);
        if (space.room_of(swing.contact(), pose) < 0.0) return true;
      }
      return false;
    });
  }

  /// Appends what lies between the last knot and `end`, and `end`.
  static bool fill(SegmentSpace& space, const std::vector<Swing>& swings, const ArcOptions& arc,
                   std::vector<Knot>& knots, const Knot& end, int depth) {
    const Knot begin = knots.back();
    const double apart = space.distance(begin.q, end.q);
    const bool swinging = !swings.empty();
    const bool fine = depth >= (swinging ? 3 : 1);
    if (fine && apart <= kNear && space.valid_between(begin.q, end.q, 0.5 * kNear, swinging)) {
      knots.push_back(end);
      return true;
    }
    if (depth >= kDeepest) return false;
    Knot middle{0.5 * (begin.t + end.t), {}};
    std::vector<Contact> places;
    for (const Swing& swing : swings) swing.add_places(space.robot(), middle.t, arc, places);
    const Eigen::VectorXd straight = space.half_way(begin.q, end.q);
    middle.q = straight;
    const bool closed =
        places.empty() && space.project(middle.q) && space.valid(middle.q, swinging);
    if (!closed && !space.solve(straight, places, middle.q)) return false;
    const double way = space.distance(begin.q, middle.q) + space.distance(middle.q, end.q);
    if (way > kLonger * apart + kLongerBy) return false;
    return fill(space, swings, arc, knots, middle, depth + 1) &&
           fill(space, swings, arc, knots, end, depth + 1);
  }

  /// From both ends half-way along the arc, each in steps from the one before; then from one to the
  /// other with what swings held there.
  static bool march(SegmentSpace& space, const std::vector<Swing>& swings, const ArcOptions& arc,
                    const Knot& begin, const Knot& end, std::vector<Knot>& knots) {
    const Eigen::VectorXd aim = space.half_way(begin.q, end.q);
    knots = {begin};
    std::vector<Knot> back = {end};
    if (!step_to(space, swings, arc, aim, knots) || !step_to(space, swings, arc, aim, back)) {
      return false;
    }
    const Knot there = std::move(back.back());
    back.pop_back();
    std::vector<Knot> over = {knots.back()};
    over.back().t = kHalf;
    if (!fill(space, swings, arc, over, {kHalf, there.q}, kMarchDepth)) return false;
    knots.insert(knots.end(), over.begin() + 1, over.end());
    knots.insert(knots.end(), back.rbegin(), back.rend());
    return true;
  }

  /// From the only knot, at one end, to half-way, towards `aim`.
  static bool step_to(SegmentSpace& space, const std::vector<Swing>& swings, const ArcOptions& arc,
                      const Eigen::VectorXd& aim, std::vector<Knot>& knots) {
    const double direction = knots.front().t < kHalf ? 1.0 : -1.0;
    for (int i = 1; i <= kMarch; ++i) {
      const Knot before = knots.back();
      Knot next{before.t + direction * kHalf / kMarch, {}};
      std::vector<Contact> places;
      for (const Swing& swing : swings) swing.add_places(space.robot(), next.t, arc, places);
      const double share = 1.0 / (kMarch - i + 1);
      if (!space.solve(space.half_way(before.q, aim, share), places, next.q) &&
          !space.solve(before.q, places, next.q)) {
        return false;
      }
      if (!fill(space, swings, arc, knots, next, kMarchDepth)) return false;
    }
    return true;
  }

  /// Puts straighter ways in place of the longest detours.
  static void shorten(SegmentSpace& space, const std::vector<Swing>& swings, const ArcOptions& arc,
                      std::vector<Knot>& knots) {
    for (const double share : kShares) {
      std::vector<double> at = {0.0};  // length of the way up to each knot
      const auto measure = [&] {
        at.resize(1);
        for (std::size_t i = 1; i < knots.size(); ++i) {
          at.push_back(at.back() + space.distance(knots[i - 1].q, knots[i].q));
        }
      };
      measure();
      const double window = share * at.back();
      for (std::size_t i = 0; i + 2 < knots.size(); ++i) {
        std::size_t j = i + 1;
        while (j + 1 < knots.size() && at[j] - at[i] < window) ++j;
        const double along = at[j] - at[i];
        if (along < window) break;
        if (along < kLeastDetour + kDetour * space.distance(knots[i].q, knots[j].q)) continue;
        std::vector<Knot> way = {knots[i]};
        if (!fill(space, swings, arc, way, knots[j], kMarchDepth + 1)) continue;
        double length = 0.0;
        for (std::size_t k = 1; k < way.size(); ++k) {
          length += space.distance(way[k - 1].q, way[k].q);
        }
        if (length > kShorter * along) continue;
        way.insert(way.end(), knots.begin() + static_cast<std::ptrdiff_t>(j) + 1, knots.end());
        knots.resize(i);
        knots.insert(knots.end(), way.begin(), way.end());
        measure();
      }
    }
  }

  static void smooth(SegmentSpace& space, bool swinging, std::vector<Knot>& knots) {
    for (int pass = 0; pass < kSmoothings; ++pass) {
      for (std::size_t i = 1; i + 1 < knots.size(); ++i) {
        if (swinging && (knots[i].t < kKept || knots[i].t > 1.0 - kKept)) continue;
        const double before = knots[i].t - knots[i - 1].t, after = knots[i + 1].t - knots[i].t;
        Eigen::VectorXd q = space.half_way(
            knots[i].q, space.half_way(knots[i - 1].q, knots[i + 1].q, before / (before + after)));
        if (space.project(q) && space.valid(q, swinging)) knots[i].q = std::move(q);
      }
    }
  }
};

}  // namespace

std::unique_ptr<SegmentPlanner> make_interpolation() { return std::make_unique<Interpolation>(); }

}  // namespace locograph
