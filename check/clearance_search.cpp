#include <locograph/check/clearance_search.h>
#include <locograph/check/limits.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace locograph {
namespace {

/// How much further than the cutoff is looked between vertices: what is beyond both may come near
/// by as much before an interval has to be halved.
constexpr double kFurther_m = 0.25;
constexpr double kEver_s = std::numeric_limits<double>::infinity();

/// One of the stance's contacts, or of its grasps, is of these links.
bool holds(const JudgedStance* stance, const std::vector<int>& links, bool grasps = false) {
  return stance != nullptr &&
         std::ranges::any_of(stance->contacts, [&](const JudgedContact& contact) {
           return (contact.is_grasp() || !grasps) &&
                  std::ranges::find(links, contact.link) != links.end();
         });
}

}  // namespace

ClearanceSearch::ClearanceSearch(CheckContext& context)
    : context_(context),
      sampler_(context.curve),
      obstacle_path_(context.world.obstacles),
      further_m_(context.moves() || (context.shapes != nullptr && obstacle_path_.end_s() > 0.0)
                     ? kFurther_m
                     : 0.0) {
  if (context.shapes != nullptr) shapes_ = *context.shapes;
}

void ClearanceSearch::add(std::size_t channel, CollisionWorld::Closest closest, int vertex,
                          double time_s) {
  if (closest.distance_m >= context_.cutoff_m) {
    closest = {};
    closest.distance_m = context_.cutoff_m;
  }
  const double sign = channels_[channel].sign;
  channels_[channel].tally->add(
      sign > 0.0 ? closest.distance_m : std::max(0.0, -closest.distance_m), vertex, time_s,
      closest.point, [&] {
        if (closest.link < 0)
          return sign > 0.0 ? std::string("nothing within reach of the distance query")
                            : std::string("nothing");
        return context_.robot.links()[std::size_t(closest.link)].name + " and " + closest.what;
      });
}

ClearanceSearch::Sample ClearanceSearch::sample(int vertex, double fraction,
                                                const JudgedStance* stance) {
  context_.begin_work(self_ ? "judging self-collisions" : "judging distances", vertex);
  Sample sample;
  sample.fraction = fraction;
  sampler_.link_poses(vertex, standing_ ? 0.0 : fraction, sample.world_from_link);
  const double time_s = this->time_s(vertex, fraction);
  ++samples_;
  if (self_) {
    CollisionWorld::Closest closest =
        context_.exact.self_distance(sample.world_from_link, context_.cutoff_m + further_m_);
    sample.distances[0] = closest.distance_m;
    add(0, std::move(closest), vertex, time_s);
    return sample;
  }
  std::vector<CollisionWorld::Touch> touches;
  if (stance != nullptr) touches = stance->touches(context_.world, sample.world_from_link);
  add_changing(vertex, fraction, stance, sample.world_from_link, touches);
  CollisionWorld::Query query{.world_from_link = sample.world_from_link,
                              .time_s = time_s,
                              .touches = touches,
                              .cutoff_m = context_.cutoff_m + further_m_,
                              .obstacles = counted_ ? &*counted_ : nullptr};
  if (one_obstacle_) {
    const CollisionWorld::Surroundings near = context_.exact.obstacles(query);
    sample.distances = {near.obstacle.distance_m, std::numeric_limits<double>::infinity(),
                        near.touched.distance_m};
    add(0, near.obstacle, vertex, time_s);
    if (stance != nullptr) add(2, near.touched, vertex, time_s);
    return sample;
  }
  CollisionWorld::Surroundings around = context_.exact.surroundings(query);
  if (keeps_from_surfaces_) keep_from_surfaces(vertex, stance, query, around.obstacle);
  sample.distances = {around.obstacle.distance_m, around.surface.distance_m,
                      around.touched.distance_m};
  add(0, around.obstacle, vertex, time_s);
  if (has_places(context_.world)) add(1, around.surface, vertex, time_s);
  if (stance != nullptr) add(2, around.touched, vertex, time_s);
  return sample;
}

int ClearanceSearch::step_of(int vertex, const JudgedStance* stance) const {
  // The end of a step is looked at with the step's stance.
  return vertex > 0 && stance != context_.stance_from(vertex) ? vertex - 1 : vertex;
}

void ClearanceSearch::add_changing(int vertex, double fraction, const JudgedStance* stance,
                                   const LinkPoses& poses,
                                   std::vector<CollisionWorld::Touch>& touches) const {
  const int at = step_of(vertex, stance);
  const std::size_t step = std::size_t(at);
  const int next = at < vertex || fraction >= 0.5 ? at + 1 : at - 1;
  const JudgedStance* around[] = {leaves_[step] ? before_[step] : nullptr,
                                  arrives_[step] ? after_[step] : nullptr};
  for (const JudgedStance* other : around) {
    if (other == nullptr) continue;
    for (CollisionWorld::Touch& touch : other->touches(context_.world, poses)) {
      if (holds(stance, touch.links)) continue;
      // In a plan of stances a hand that takes or leaves a bar is closed round it.
      const bool takes = context_.motion.stances_only && next >= 0 &&
                         next < int(context_.vertices()) && other == context_.stance_from(next);
      const bool is_grasp = !touch.bars.empty() && holds(other, touch.links, true);
      touch.barely = touch.barely || !(takes && is_grasp);
      touches.push_back(std::move(touch));
    }
  }
}

void ClearanceSearch::keep_from_surfaces(int vertex, const JudgedStance* stance,
                                         CollisionWorld::Query query,
                                         CollisionWorld::Closest& nearest) const {
  const std::size_t from = std::size_t(step_of(vertex, stance));
  std::vector<CollisionWorld::Touch> touches(query.touches.begin(), query.touches.end());
  for (const JudgedStance* other : {before_[from], after_[from]}) {
    if (other == nullptr) continue;
    const std::vector<CollisionWorld::Touch> more =
        other->touches(context_.world, query.world_from_link);
    touches.insert(touches.end(), more.begin(), more.end());
  }
  query.touches = touches;
  query.surface_cutoff_m = query.cutoff_m;
  CollisionWorld::Closest surface = context_.exact.surroundings(query).surface;
  if (surface.distance_m < nearest.distance_m) nearest = std::move(surface);
}

void ClearanceSearch::find_stances_around() {
  const std::size_t vertices = context_.vertices();
  before_.assign(vertices, nullptr);
  after_.assign(vertices, nullptr);
  const auto stance = [this](std::size_t i) { return context_.stance_from(int(i)); };
  for (std::size_t i = 1; i < vertices; ++i) {
    before_[i] = stance(i) == stance(i - 1) ? before_[i - 1] : stance(i - 1);
  }
  for (std::size_t i = vertices; i-- > 1;) {
    after_[i - 1] = stance(i) == stance(i - 1) ? after_[i] : stance(i);
  }
  leaves_.assign(vertices, true);
  arrives_.assign(vertices, true);
  for (std::size_t i = 1; i < vertices; ++i) {
    if (stance(i) == stance(i - 1)) leaves_[i] = leaves_[i - 1] && is_near(before_[i], int(i));
  }
  for (std::size_t i = vertices; i-- > 1;) {
    if (stance(i) == stance(i - 1)) arrives_[i - 1] = arrives_[i] && is_near(after_[i], int(i));
  }
}

bool ClearanceSearch::is_near(const JudgedStance* other, int vertex) {
  if (other == nullptr || !context_.usable.vertices[std::size_t(vertex)]) return false;
  const JudgedStance* stance = context_.stance_from(vertex);
  LinkPoses poses;
  sampler_.link_poses(vertex, 0.0, poses);
  return std::ranges::any_of(other->contacts, [&](const JudgedContact& contact) {
    if (holds(stance, contact.links)) return false;
    if (contact.is_ball()) return closure_error(contact, poses).position_m <= limits::kClosed_m;
    const Eigen::Vector3d off = touching_point(contact, poses) - contact.contact.position;
    return std::abs(contact.normal.dot(off)) <= limits::kClosed_m;
  });
}

double ClearanceSearch::path_bound(int step, const Sample& from, const Sample& to,
                                   const Channel& channel) const {
  const double fraction = to.fraction - from.fraction;
  const MovingShapes& shapes = *shapes_;
  if (self_) return shapes.relative_path_bound(from.world_from_link, to.world_from_link, fraction);
  const double robot =
      shapes.path_bound(from.world_from_link, to.world_from_link, fraction, channel.links);
  if (&channel != &channels_[0]) return robot;  // surfaces do not move, nor what may be touched
  const double from_s = time_s(step, from.fraction), to_s = time_s(step, to.fraction);
  if (!counted_) return robot + obstacle_path_.bound(from_s, to_s);
  double longest = 0.0;
  for (const std::size_t o : *counted_) {
    longest = std::max(longest, obstacle_path_.bound(o, from_s, to_s));
  }
  return robot + longest;
}

void ClearanceSearch::refine(int step, const JudgedStance* stance, const Sample& from,
                             const Sample& to) {
  const double resolution = context_.options.clearance_resolution_m;
  bool matters = false;
  for (std::size_t c = 0; c < channels_.size() && !matters; ++c) {
    const Channel& channel = channels_[c];
    if (!channel.exists || channel.tally->empty()) continue;
    const double limit = channel.sign * channel.tally->limit();
    const double worst = channel.sign * channel.tally->worst();
    const double ends = from.distances[c] + to.distances[c];
    const double bound = 0.5 * (ends - path_bound(step, from, to, channel));
    const bool new_minimum = channel.seeks_minimum && bound < worst - resolution;
    const bool new_violation = !channel.tally->violated_at(step) && bound < limit - resolution;
    matters = new_minimum || new_violation;
  }
  if (!matters) return;
  const double middle = 0.5 * (from.fraction + to.fraction);
  if (middle <= from.fraction || middle >= to.fraction) return;
  const Sample between = sample(step, middle, stance);
  refine(step, stance, from, between);
  refine(step, stance, between, to);
}

void ClearanceSearch::run_step(int step, const JudgedStance* stance, const Sample& from,
                               const Sample& to) {
  if (standing_) {
    StepBounds still;
    still.joints = still.joint_bends = Eigen::VectorXd::Zero(context_.robot.active_joint_count());
    shapes_->set_step(still);
  } else {
    shapes_->set_step(context_.curve.step(step).bounds());
  }
  if (!self_) channels_[2].links = stance == nullptr ? nullptr : &stance->touching;
  Sample begin = from, end = to;
  begin.fraction = 0.0;
  end.fraction = 1.0;
  const double begin_s = standing_ ? from_s_ : context_.motion.time_s[std::size_t(step)];
  const double end_s = standing_ ? to_s_ : context_.motion.time_s[std::size_t(step) + 1];
  std::vector<std::size_t> lasting, changing;
  for (std::size_t o = 0; !self_ && o < context_.world.obstacles.size(); ++o) {
    const Obstacle& obstacle = context_.world.obstacles[o];
    if (!obstacle.is_there(begin_s, end_s)) continue;
    const bool lasts = obstacle.appears_s <= begin_s && obstacle.vanishes_s >= end_s;
    const bool by_itself = !lasts || (standing_ && !obstacle.motion.empty());
    (by_itself ? changing : lasting).push_back(o);
  }
  if (!changing.empty()) counted_ = std::move(lasting);
  refine(step, stance, begin, end);
  for (const std::size_t o : changing) look_at_obstacle(step, stance, o, begin_s, end_s);
  counted_.reset();
}

void ClearanceSearch::look_at_obstacle(int step, const JudgedStance* stance, std::size_t obstacle,
                                       double begin_s, double end_s) {
  const Obstacle& one = context_.world.obstacles[obstacle];
  earliest_s_ = std::max(begin_s, one.appears_s);
  latest_s_ = std::min(end_s, one.vanishes_s);
  if (standing_) latest_s_ = std::min(latest_s_, obstacle_path_.seen_s(obstacle, earliest_s_));
  counted_ = {obstacle};
  one_obstacle_ = true;
  const auto at = [&](double time_s) {
    return sample(step, (time_s - begin_s) / (end_s - begin_s), stance);
  };
  const Sample comes = at(earliest_s_);
  if (latest_s_ > earliest_s_) refine(step, stance, comes, at(latest_s_));
  one_obstacle_ = false;
  earliest_s_ = -kEver_s;
  latest_s_ = kEver_s;
}

void ClearanceSearch::stand(int vertex, const JudgedStance* stance, double from_s, double to_s) {
  // By then each obstacle has been wherever it gets to, from then on.
  to_s = std::min(to_s, from_s + obstacle_path_.end_s());
  if (!shapes_ || !(to_s > from_s)) return;
  standing_ = true;
  from_s_ = from_s;
  to_s_ = to_s;
  const Sample from = sample(vertex, 0.0, stance);
  run_step(vertex, stance, from, sample(vertex, 1.0, stance));
  standing_ = false;
}

void ClearanceSearch::run_around(ViolationTally& obstacle, ViolationTally& surface,
                                 ViolationTally& touching) {
  self_ = false;
  const World& world = context_.world;
  channels_ = {{&obstacle, 1.0, true}, {&surface, -1.0, false}, {&touching, -1.0, false}};
  keeps_from_surfaces_ = context_.options.min_clearance_m > 0.0 && has_places(world);
  find_stances_around();
  channels_[0].exists = world.map != nullptr || !world.obstacles.empty() || keeps_from_surfaces_;
  const std::size_t vertices = context_.vertices();
  const JudgedStance* stance = nullptr;
  Sample here;
  bool sampled = false;  // `here` is this vertex with `stance`
  for (std::size_t i = 0; i < vertices; ++i) {
    const int vertex = int(i);
    if (!context_.usable.vertices[i]) {
      sampled = false;
      continue;
    }
    const JudgedStance* next = context_.stance_from(vertex);
    if (context_.motion.stances_only) {
      stand(vertex, next, 0.0, obstacle_path_.end_s());
    } else if (i == 0 && context_.options.starts_at_rest) {
      stand(vertex, next, 0.0, context_.motion.time_s[i]);
    }
    if (!sampled || next != stance) here = sample(vertex, 0.0, next);
    stance = next;
    if (i + 1 == vertices) {
      if (context_.options.until_s && !context_.motion.stances_only)
        stand(vertex, stance, context_.motion.time_s[i], *context_.options.until_s);
      break;
    }
    if (!context_.usable.vertices[i + 1]) continue;
    // The next vertex as the end of this step; there it is looked at with this step's stance.
    Sample there = sample(vertex + 1, 0.0, stance);
    if (context_.usable.steps[i]) run_step(vertex, stance, here, there);
    here = std::move(there);
    sampled = true;
  }
}

void ClearanceSearch::run_self(ViolationTally& tally) {
  self_ = true;
  channels_ = {{&tally, 1.0, true}};
  Sample here;
  bool sampled = false;
  for (std::size_t i = 0; i < context_.vertices(); ++i) {
    if (!context_.usable.vertices[i]) {
      sampled = false;
      continue;
    }
    Sample there = sample(int(i), 0.0, nullptr);
    if (sampled && context_.usable.steps[i - 1]) run_step(int(i) - 1, nullptr, here, there);
    here = std::move(there);
    sampled = true;
  }
}

}  // namespace locograph
