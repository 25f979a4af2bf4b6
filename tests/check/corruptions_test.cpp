// The liar's corpus on the motions that these tests have: every original is accepted, every lie is
// refused by the constraint that it breaks. Longer: benchmarks/planners/liar_campaign.cpp.
#include "check/corruptions.h"

#include <gtest/gtest.h>

#include "check/centauro_on_wheels.h"
#include "check/coman_plus_standing.h"
#include "common/sanitized.h"

namespace locograph::test {
namespace {

CheckOptions knowing(const std::vector<EndEffector>& known) {
  CheckOptions options;
  options.known = known;
  options.base_linear_m_s = 0.5;
  return options;
}

/// The left hand touches a little table with its ball.
void lean_on_a_ball(Honest& honest) {
  RobotState state(*honest.robot);
  state.update(standing().home.data());
  Contact ball;
  ball.effector = {.name = "left_hand",
                   .link = "LBall",
                   .kind = ContactKind::kPoint,
                   .point = {0.0, 0.0, -0.0105},
                   .radius_m = 0.071,
                   .friction = 0.5,
                   .max_force_N = 1000.0};
  const int link = honest.robot->link_index(ball.effector.link);
  ball.position = state.world_from_link(link) * ball.effector.point -
                  ball.effector.radius_m * Eigen::Vector3d::UnitZ();
  honest.motion.stances[0].contacts.push_back(ball);
  honest.options.known.push_back(ball.effector);
  Surface table = ground();
  table.name = "table";
  table.world_from_surface.translation() = ball.position;
  table.half_x_m = table.half_y_m = 0.02;
  honest.world.surfaces.push_back(table);
}

std::vector<Honest> honest_motions() {
  std::vector<EndEffector> wheels;
  for (const Contact& contact : centauro().wheels.contacts) wheels.push_back(contact.effector);
  World flat;
  flat.surfaces = {ground()};
  Motion still = standing().motion(1);
  Honest with_a_ball = {"leaning on a ball", standing().robot, flat, standing().motion(4),
                        knowing(standing().known)};
  lean_on_a_ball(with_a_ball);
  return {
      with_a_ball,
      {"standing", standing().robot, flat, still, knowing(standing().known)},
      {"moving an arm", standing().robot, flat, standing().motion(4), knowing(standing().known)},
      {"parked", centauro().shared, flat, centauro().drive(1, 0.08, 0.8), knowing(wheels)},
      {"driving", centauro().shared, flat, centauro().drive(5, 0.08, 0.8), knowing(wheels)}};
}

TEST(Corruptions, OriginalsAreAcceptedAndEveryLieIsRefusedByName) {
  std::mt19937_64 random(1);
  const int rounds = kSanitized ? 1 : 3;
  int lies = 0;
  std::set<std::string> told;
  for (const Honest& honest : honest_motions()) {
    const Judge judge(honest.robot, honest.world);
    EXPECT_EQ(violated(judge.check(honest.motion, honest.options)), std::set<std::string>{})
        << honest.name;
    for (const Corruption& corruption : corruptions()) {
      for (int round = 0; round < rounds; ++round) {
        const std::optional<Lie> lie = corruption.make(honest, random);
        if (!lie) continue;
        ++lies;
        told.insert(corruption.name);
        const Verdict verdict = judge_lie(honest, judge, *lie);
        EXPECT_TRUE(verdict.refused) << honest.name << ", " << corruption.name;
        EXPECT_TRUE(verdict.by_name)
            << honest.name << ", " << corruption.name << ", refused for " << verdict.violated;
      }
    }
  }
  // No corruption may be one that never finds anything to lie about.
  EXPECT_EQ(told.size(), corruptions().size());
  EXPECT_GE(lies, 60 * rounds);
}

}  // namespace
}  // namespace locograph::test
