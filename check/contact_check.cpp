#include <locograph/check/contact_check.h>
#include <locograph/check/limits.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace locograph {
namespace {

Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turned(rotation);
  return turned.angle() * turned.axis();
}

/// The joint that a wheel turns about.
const Joint& axle_of(const Robot& robot, const JudgedContact& wheel) {
  return robot.joints()[std::size_t(robot.links()[std::size_t(wheel.link)].parent_joint)];
}

/// The link that is fixed to what a contact holds: of a wheel, the one that carries it.
int held_link(const Robot& robot, const JudgedContact& contact) {
  return contact.is_wheel() ? axle_of(robot, contact).parent_link : contact.link;
}

/// The angle of a wheel's carrier about the axle, from the plane's normal, but for a constant.
double carrier_pitch(const JudgedContact& wheel, const Joint& axle,
                     const Eigen::Matrix3d& carrier) {
  const Eigen::Vector3d in_carrier = axle.parent_from_joint.linear() * axle.axis;
  const Eigen::Vector3d upright = carrier * in_carrier.unitOrthogonal();
  return std::atan2(wheel.normal.cross(upright).dot(carrier * in_carrier),
                    wheel.normal.dot(upright));
}

/// What is held of a contact's orientation, as a vector that moves as far as it turns. Of a wheel
/// how far it turns on the ground: about its joint, and as its carrier pitches.
Eigen::Vector3d held_turn(const JudgedContact& contact, const Eigen::Matrix3d& first,
                          const Eigen::Matrix3d& now, const Eigen::VectorXd& configuration,
                          const Robot& robot) {
  const EndEffector& effector = contact.contact.effector;
  switch (effector.kind) {
    case ContactKind::kSurface:
      return rotation_vector(now * first.transpose());
    case ContactKind::kGrasp:
      return (now * effector.normal.cross(effector.forward)).normalized();
    case ContactKind::kWheel: {
      const Joint& axle = axle_of(robot, contact);
      const double pitched =
          std::remainder(carrier_pitch(contact, axle, now) - carrier_pitch(contact, axle, first),
                         2.0 * std::numbers::pi);
      const int joint = contact.wheel_joint;
      const double spin = joint < 0 ? 0.0 : configuration[robot.base_configuration_size() + joint];
      return {spin + pitched, 0.0, 0.0};
    }
    case ContactKind::kPoint:
      break;
  }
  return Eigen::Vector3d::Zero();
}

bool same_place(const Contact& a, const Contact& b) {
  if (!((a.position - b.position).norm() <= limits::kClosed_m)) return false;
  if (!(angle_between(a.normal, b.normal) <= limits::kClosed_rad)) return false;
  if (!a.forward || !b.forward) return true;
  const Eigen::Vector3d across = a.normal.cross(*a.forward);
  return angle_between(across, b.normal.cross(*b.forward)) <= limits::kClosed_rad;
}

bool same_contacts(const JudgedStance& a, const JudgedStance& b) {
  if (a.contacts.size() != b.contacts.size()) return false;
  for (const JudgedContact& contact : a.contacts) {
    if (std::none_of(b.contacts.begin(), b.contacts.end(), [&](const JudgedContact& other) {
          return same_effector(contact, other) && contact.contact.locked == other.contact.locked;
        }))
      return false;
  }
  return true;
}

const std::string& name_of_place(const JudgedContact& contact, const World& world) {
  if (!contact.surfaces.empty()) return world.surfaces[std::size_t(contact.surfaces.front())].name;
  return world.bars[std::size_t(contact.bars.front())].name;
}

ViolationTally at_most(const char* name, const char* unit, double limit, std::size_t vertices) {
  return ViolationTally(name, unit, limit, Worse::kHigher, vertices);
}

}  // namespace

ContactCheck::ContactCheck(CheckContext& context)
    : context_(context),
      between_samples_(context.curve),
      position_(at_most("contact_position", "m", limits::kClosed_m, context.vertices())),
      orientation_(at_most("contact_orientation", "rad", limits::kClosed_rad, context.vertices())),
      between_(at_most("contact_between", "m", limits::kHeld_m, context.vertices())),
      motion_(at_most("contact_motion", "m", limits::kHeld_m, context.vertices())),
      turn_(at_most("contact_turn", "rad", limits::kHeld_rad, context.vertices())),
      relabelled_(at_most("contact_relabelled", "count", 0.0, context.vertices())),
      surface_(at_most("contact_on_surface", "m", limits::kClosed_m, context.vertices())),
      lateral_(at_most("lateral_slip", "m", limits::kSlip_m, context.vertices())),
      longitudinal_(at_most("longitudinal_slip", "m", limits::kSlip_m, context.vertices())) {}

void ContactCheck::run() {
  const Motion& motion = context_.motion;
  MotionSampler sampler(context_.curve);
  LinkPoses poses, before, older;
  for (std::size_t i = 0; i < context_.vertices(); ++i) {
    const int vertex = int(i);
    context_.begin_work("judging contacts", vertex);
    if (!context_.usable.vertices[i]) {
      begin(nullptr, {vertex, 0.0, poses, motion.configurations[i]});
      continue;
    }
    sampler.link_poses(vertex, 0.0, poses);
    const Sample at{vertex, motion.time_s[i], poses, motion.configurations[i]};
    ++context_.samples;
    check_vertex(at);
    if (i > 0) check_relabelled(vertex);
    begin(context_.stance_from(vertex), at);
    if (i + 1 == context_.vertices()) break;
    if (motion.stances_only && context_.usable.vertices[i + 1]) {
      std::swap(before, poses);
      sampler.link_poses(vertex, 1.0, poses);
      keep({vertex, motion.time_s[i + 1], poses, motion.configurations[i + 1]}, before);
      continue;
    }
    if (!context_.usable.steps[i]) {
      begin(nullptr, at);
      continue;
    }
    int samples = stance_ == nullptr ? 0 : context_.samples_per_step[i];
    const bool rolls =
        std::ranges::any_of(tracks_, [](const Track& track) { return track.contact->is_ball(); });
    if (rolls) samples += samples % 2;
    for (int k = 1; k <= samples; ++k) {
      const double fraction = double(k) / samples;
      std::swap(older, before);
      std::swap(before, poses);
      sampler.link_poses(vertex, fraction, poses);
      const Sample now{vertex, context_.curve.time_s(vertex, fraction), poses,
                       sampler.configuration()};
      if (k < samples) {
        ++context_.samples;
        check_between(now);
      }
      keep(now, before);
      if (rolls && k % 2 == 0) roll_in_step(now, double(k - 2) / samples, fraction, older, before);
    }
  }
}

void ContactCheck::check_vertex(const Sample& sample) {
  for (const JudgedStance* stance : context_.stances_at(sample.vertex)) {
    for (const JudgedContact& contact : stance->contacts) {
      ContactError error = closure_error(contact, sample.poses);
      const Eigen::Vector3d at = touching_point(contact, sample.poses);
      const auto name = [&] { return contact.name(); };
      if (contact.is_ball() && touches_down(contact, sample.vertex))
        error.position_m = (at - contact.contact.position).norm();
      position_.add(error.position_m, sample.vertex, sample.time_s, at, name);
      if (error.holds_direction)
        orientation_.add(error.angle_rad, sample.vertex, sample.time_s, at, name);
      check_surface(contact, sample);
    }
  }
}

void ContactCheck::check_surface(const JudgedContact& contact, const Sample& sample) {
  if (!has_places(context_.world)) return;
  const Eigen::Vector3d at = touching_point(contact, sample.poses);
  if (!contact.is_placed()) {
    if (!context_.options.surfaces_known) return;
    surface_.add(contact.off_surface_m, sample.vertex, sample.time_s, at, [&] {
      return contact.name() + (contact.is_grasp() ? " holds no bar of the world"
                                                  : " touches no surface of the world");
    });
    return;
  }
  const Support support = support_of(contact, context_.world, sample.poses);
  surface_.add(support.outside_m, sample.vertex, sample.time_s, at, [&] {
    return contact.name() + (support.outside_m > 0.0 ? " is beyond the border of " : " on ") +
           name_of_place(contact, context_.world);
  });
}

void ContactCheck::check_between(const Sample& sample) {
  for (const JudgedContact& contact : stance_->contacts) {
    const ContactError error = closure_error(contact, sample.poses);
    const double as_length = error.angle_rad * (limits::kHeld_m / limits::kHeld_rad);
    between_.add(std::max(error.position_m, as_length), sample.vertex, sample.time_s,
                 touching_point(contact, sample.poses),
                 [&] { return contact.name() + (as_length > error.position_m ? " turned" : ""); });
    if (contact.is_wheel() || contact.is_ball()) check_surface(contact, sample);
  }
}

void ContactCheck::check_relabelled(int vertex) {
  const JudgedStance *before = context_.stance_from(vertex - 1),
                     *after = context_.stance_from(vertex);
  if (before == nullptr || after == nullptr || before == after) return;
  int changed = 0;
  std::string what;
  for (const JudgedContact& contact : after->contacts) {
    for (const JudgedContact& held : before->contacts) {
      if (!same_effector(held, contact) || !contact.is_held() || !held.is_held()) continue;
      // Also after many small steps.
      const auto track = std::ranges::find(tracks_, &held, &Track::contact);
      const JudgedContact& first = track == tracks_.end() ? held : *track->label;
      if (same_place(held.contact, contact.contact) && same_place(first.contact, contact.contact))
        continue;
      ++changed;
      what = contact.name() + " is held at two places";
    }
  }
  if (changed == 0 && context_.motion.stances_only && same_contacts(*before, *after)) {
    changed = 1;
    what = "a stance follows its like";
  }
  relabelled_.add(changed, vertex, context_.motion.time_s[std::size_t(vertex)],
                  Eigen::Vector3d::Zero(), [&] { return what; });
}

void ContactCheck::begin(const JudgedStance* stance, const Sample& sample) {
  if (stance == stance_) return;
  std::vector<Track> old = std::move(tracks_);
  tracks_.clear();
  stance_ = stance;
  if (stance == nullptr) return;
  for (const JudgedContact& contact : stance->contacts) {
    const Eigen::Vector3d at = touching_point(contact, sample.poses);
    Track track;
    track.contact = track.label = &contact;
    track.last = at;
    track.first = sample.poses[std::size_t(held_link(context_.robot, contact))].linear();
    // Of several contacts of the body: the nearest one.
    const Track* nearest = nullptr;
    double least = 0.0;
    for (const Track& candidate : old) {
      if (candidate.contact->body != contact.body) continue;
      if (same_effector(*candidate.contact, contact) && candidate.contact->is_held())
        track.label = candidate.label;
      const double apart = (touching_point(*candidate.contact, sample.poses) - at).norm();
      if (nearest != nullptr && apart >= least) continue;
      nearest = &candidate;
      least = apart;
    }
    if (nearest != nullptr) {
      // Also from a wheel to a held contact and back: calling it the other is no way to slide.
      track.slip = nearest->slip;
      track.place = nearest->place;
      track.path = nearest->path;
      track.last = nearest->last;
      track.offset = track.last - at;
      if (contact.contact.effector.kind == nearest->contact->contact.effector.kind &&
          contact.link == nearest->contact->link) {
        track.turn = nearest->turn;
        track.first = nearest->first;
      }
    }
    tracks_.push_back(std::move(track));
    keep_place(tracks_.back(), sample);
  }
}

void ContactCheck::keep_place(Track& track, const Sample& sample) {
  const JudgedContact& contact = *track.contact;
  if (!contact.is_held()) return;
  const Eigen::Vector3d at = touching_point(contact, sample.poses);
  const Eigen::Matrix3d& now =
      sample.poses[std::size_t(held_link(context_.robot, contact))].linear();
  if (contact.is_ball()) {
    // What it slips is added as it rolls.
    track.offset = track.last - at;
  } else {
    track.last = at + track.offset;
  }
  track.place.add(track.last);
  track.turn.add(held_turn(contact, track.first, now, sample.configuration, context_.robot));
}

void ContactCheck::keep(const Sample& sample, const LinkPoses& before) {
  for (Track& track : tracks_) {
    const JudgedContact& contact = *track.contact;
    const Eigen::Vector3d at = touching_point(contact, sample.poses);
    // What has been added up counts where it grows, not ever after.
    const auto add = [&](ViolationTally& tally, double was, double is) {
      if (is > was * (1.0 + 1e-9) || tally.empty())
        tally.add(is, sample.vertex, sample.time_s, at, [&] { return contact.name(); });
    };
    if (contact.is_ball()) {
      if (context_.motion.stances_only)
        roll(track, sample, [&] {
          track.path.add(skin_step(contact, before[std::size_t(contact.link)],
                                   sample.poses[std::size_t(contact.link)]));
        });
      continue;
    }
    if (contact.is_held()) {
      const double moved = track.place.size(), turned = track.turn.size();
      keep_place(track, sample);
      add(motion_, moved, track.place.size());
      if (contact.contact.effector.kind != ContactKind::kPoint)
        add(turn_, turned, track.turn.size());
    }
    if (!contact.is_wheel() || context_.motion.stances_only) continue;
    if (!track.slip) track.slip.emplace();
    WheelSlip& slip = *track.slip;
    const double across = slip.lateral_m(), along = slip.longitudinal_m();
    slip.add(wheel_step(contact, before, sample.poses));
    add(lateral_, across, slip.lateral_m());
    add(longitudinal_, along, slip.longitudinal_m());
  }
}

void ContactCheck::roll_in_step(const Sample& sample, double from, double to,
                                const LinkPoses& older, const LinkPoses& before) {
  LinkPoses poses;
  for (Track& track : tracks_) {
    const JudgedContact& contact = *track.contact;
    if (!contact.is_ball()) continue;
    const std::size_t link = std::size_t(contact.link);
    roll(track, sample, [&] {
      track.path.add(
          contact, {{from, 0.5 * (from + to), to}, {older[link], before[link], sample.poses[link]}},
          [&](double fraction) {
            between_samples_.link_poses(sample.vertex, fraction, poses);
            return poses[link];
          });
    });
  }
}

void ContactCheck::roll(Track& track, const Sample& sample, const auto& along) {
  const JudgedContact& contact = *track.contact;
  const double slipped = track.path.slip_m();
  const Eigen::Vector3d before = track.path.slip();
  along();
  // Called something else it has slid all the same.
  track.last += track.path.slip() - before;
  keep_place(track, sample);
  if (track.path.slip_m() > slipped * (1.0 + 1e-9) || motion_.empty())
    motion_.add(track.path.slip_m(), sample.vertex, sample.time_s,
                touching_point(contact, sample.poses),
                [&] { return contact.name() + ", its skin"; });
  BallRolling& rolling = rolling_[contact.name()];
  rolling.way_m = std::max(rolling.way_m, track.path.way_m());
  rolling.slip_m = std::max(rolling.slip_m, track.path.slip_m());
}

bool ContactCheck::touches_down(const JudgedContact& contact, int vertex) const {
  const JudgedStance* after = context_.stance_from(vertex);
  const auto is_held_in = [&](const JudgedStance& stance) {
    return std::ranges::any_of(
        stance.contacts, [&](const JudgedContact& other) { return same_effector(contact, other); });
  };
  if (after == nullptr || !is_held_in(*after)) return false;
  if (vertex == 0) return context_.options.starts_at_rest;
  const JudgedStance* before = context_.stance_from(vertex - 1);
  return before == nullptr || !is_held_in(*before);
}

std::vector<BallRolling> ContactCheck::ball_rolling() const {
  std::vector<BallRolling> all;
  for (const auto& [name, rolling] : rolling_) {
    all.push_back(rolling);
    all.back().end_effector = name;
  }
  return all;
}

void ContactCheck::report(std::vector<Violation>& violations) const {
  const std::string still = context_.moves() ? "no contact is known" : context_.why_nothing_moves();
  const bool follows =
      context_.moves() || (context_.motion.stances_only && context_.vertices() > 1);
  const std::string held = follows ? "no contact is held where it is" : still;
  violations.push_back(position_.result("no contact is known"));
  violations.push_back(orientation_.result("no contact holds a direction"));
  violations.push_back(between_.result(still));
  violations.push_back(motion_.result(held));
  violations.push_back(turn_.result(held));
  violations.push_back(relabelled_.result("the stance does not change"));
  violations.push_back(surface_.result(has_places(context_.world)
                                           ? "no contact is on a surface that the world has"
                                           : "the world has no surfaces"));
  const std::string wheels = context_.moves() ? "no wheel is in contact" : still;
  violations.push_back(lateral_.result(wheels));
  violations.push_back(longitudinal_.result(wheels));
}

std::optional<double> ContactCheck::max_contact_error_m() const {
  if (position_.empty()) return std::nullopt;
  return position_.worst();
}

}  // namespace locograph
