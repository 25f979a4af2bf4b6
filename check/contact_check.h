#pragma once
/// Judges contacts along a motion: closed, kept, on their surfaces and bars, and wheels rolling.
///
///     ContactCheck check(context);
///     check.run();
///     check.report(report.violations);
///
/// A contact is followed over all steps in a row whose stances hold one on the same body: by
/// whatever name and with whatever point of it, how far it gets is summed up, so that neither finer
/// steps nor new labels buy anything. Wheels are followed alike, and balls, which roll
/// (ball_rolling.h): what their skin slips is what they get to. A ball touches down where a stance
/// begins that holds it after one that does not, and there it is at its contact's position. A part
/// of a motion may begin anywhere on its way.

#include <locograph/check/ball_rolling.h>
#include <locograph/check/check_context.h>
#include <locograph/check/extent.h>
#include <locograph/check/violation_tally.h>
#include <locograph/check/wheel_rolling.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace locograph {

class ContactCheck {
 public:
  explicit ContactCheck(CheckContext& context);

  void run();
  void report(std::vector<Violation>& violations) const;
  std::optional<double> max_contact_error_m() const;
  /// By name, of those that were followed.
  std::vector<BallRolling> ball_rolling() const;

 private:
  /// A contact of the present stance, and what it has done since it began.
  struct Track {
    const JudgedContact* contact = nullptr;
    const JudgedContact* label = nullptr;  // what it was called when it began to be held
    // What of the way was covered with other points of the body, and where it all has led.
    Eigen::Vector3d offset = Eigen::Vector3d::Zero(), last = Eigen::Vector3d::Zero();
    Eigen::Matrix3d first = Eigen::Matrix3d::Identity();  // of its link; a wheel's: of the carrier
    Extent place, turn;
    std::optional<WheelSlip> slip;  // of what is or has been a wheel
    SkinPath path;                  // of what is or has been a ball
  };
  struct Sample {
    int vertex = 0;
    double time_s = 0.0;
    const LinkPoses& poses;
    const Eigen::VectorXd& configuration;
  };

  void check_vertex(const Sample& sample);
  void check_between(const Sample& sample);
  void check_surface(const JudgedContact& contact, const Sample& sample);
  void check_relabelled(int vertex);
  void begin(const JudgedStance* stance, const Sample& sample);
  void keep(const Sample& sample, const LinkPoses& before);
  void keep_place(Track& track, const Sample& sample);
  void roll_in_step(const Sample& sample, double from, double to, const LinkPoses& older,
                    const LinkPoses& before);
  void roll(Track& track, const Sample& sample, const auto& along);
  bool touches_down(const JudgedContact& contact, int vertex) const;

  CheckContext& context_;
  MotionSampler between_samples_;
  std::map<std::string, BallRolling> rolling_;
  const JudgedStance* stance_ = nullptr;  // that is followed
  std::vector<Track> tracks_;
  ViolationTally position_, orientation_, between_, motion_, turn_, relabelled_, surface_, lateral_,
      longitudinal_;
};

}  // namespace locograph
