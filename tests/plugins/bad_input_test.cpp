#include "plugins/bad_line.h"
#include "plugins/small_robot.h"

namespace locograph::test {
namespace {

// A good plan: parameters 0 to 4 and vertices 0 and 1.
constexpr const char* kGood =
    "PARAMS_ROBOT 0 cart.urdf cart.srdf floating 0\n"
    "PARAMS_PLAN 1 3\n"
    "PARAMS_WORLD 2 - -\n"
    "PARAMS_CONTACT 3 0 wheel wheel wheel 0.1 0.8 100 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free\n"
    "PARAMS_STANCE 5 1 3\n"
    "VERTEX_CONFIGURATION 0 0 0 - 0 0 0 0 0 0 1 0.1 0.2 0.3\n"
    "VERTEX_CONFIGURATION 1 0 1 5 0 0 0 0 0 0 1 0.1 0.2 0.3\n";

const BadLine kBadLines[] = {
    // VERTEX_CONFIGURATION
    {"VertexOfAnUnknownRobot", "VERTEX_CONFIGURATION 9 55 0 - 0 0 0 0 0 0 1 0 0 0",
     "unknown parameter 55"},
    {"VertexOfAParameterThatIsNoRobot", "VERTEX_CONFIGURATION 9 2 0 - 0 0 0 0 0 0 1 0 0 0",
     "parameter 2 is a PARAMS_WORLD"},
    {"VertexWithTooFewJoints", "VERTEX_CONFIGURATION 9 0 0 - 0 0 0 0 0 0 1 0 0", "too few fields"},
    {"VertexWithTooManyJoints",
     "VERTEX_CONFIGURATION 9 0 0 - 0 0 0 0 0 0 1 0 0 0 1 2 3 4 5 6 7 8 9 7",
     "too many fields, from '7' on"},
    {"VertexWithTooFewSlopes", "VERTEX_CONFIGURATION 9 0 0 - 0 0 0 0 0 0 1 0 0 0 7",
     "too few fields"},
    {"VertexFasterThanAnything",
     "VERTEX_CONFIGURATION 9 0 0 - 0 0 0 0 0 0 1 0 0 0 1 2 3 4 5 6 7 8 1e7",
     "a slope of 1e+07 per second, expected at most 1e+06 per second"},
    {"VertexBeforeTheClock", "VERTEX_CONFIGURATION 9 0 -0.5 - 0 0 0 0 0 0 1 0 0 0",
     "a time of -0.500000 s, expected 0 or later"},
    {"VertexWithoutTime", "VERTEX_CONFIGURATION 9 0", "too few fields"},
    {"VertexWithAZeroQuaternion", "VERTEX_CONFIGURATION 9 0 0 - 1 2 3 0 0 0 0 0 0 0",
     "quaternion of length zero"},
    {"VertexWithANaNJoint", "VERTEX_CONFIGURATION 9 0 0 - 0 0 0 0 0 0 1 0 nan 0",
     "'nan' is not finite"},
    {"VertexWithANaNTime", "VERTEX_CONFIGURATION 9 0 nan - 0 0 0 0 0 0 1 0 0 0",
     "'nan' is not finite"},
    {"VertexWithAnInfinitePosition", "VERTEX_CONFIGURATION 9 0 0 - inf 0 0 0 0 0 1 0 0 0",
     "'inf' is not finite"},
    {"VertexFartherThanAnythingIs", "VERTEX_CONFIGURATION 9 0 0 - 0 1e16 0 0 0 0 1 0 0 0",
     "a base at 1e+16 m, expected at most 1e+06 m"},
    {"VertexWithAJointBeyondAllTurns", "VERTEX_CONFIGURATION 9 0 0 - 0 0 0 0 0 0 1 0 1e300 0",
     "a joint at 1e+300, expected at most 1e+06"},
    {"VertexInAnotherAge", "VERTEX_CONFIGURATION 9 0 1e12 - 0 0 0 0 0 0 1 0 0 0",
     "a time of 1e+12 s, expected at most 1e+06 s"},
    {"VertexTwice", "VERTEX_CONFIGURATION 1 0 0 - 0 0 0 0 0 0 1 0 0 0", "declared twice"},
    // PARAMS_ROBOT
    {"RobotWithoutUrdf", "PARAMS_ROBOT 4 nowhere.urdf - floating 0", "nowhere.urdf"},
    {"RobotWithoutSrdf", "PARAMS_ROBOT 4 cart.urdf nowhere.srdf floating 0", "nowhere.srdf"},
    {"RobotWithAnUnknownBase", "PARAMS_ROBOT 4 cart.urdf - swimming 0",
     "base 'swimming', expected 'floating' or 'fixed'"},
    {"RobotWithAnUnknownActiveJoint", "PARAMS_ROBOT 4 cart.urdf - floating 1 leg", "leg"},
    {"RobotWithFewerNamesThanAnnounced", "PARAMS_ROBOT 4 cart.urdf - floating 2 arm_joint",
     "too few fields"},
    {"RobotWithMoreNamesThanAnnounced", "PARAMS_ROBOT 4 cart.urdf - floating 0 arm_joint",
     "'arm_joint', expected 'lenient', 'frozen' or the end of the line"},
    {"RobotWithANegativeNumberOfNames", "PARAMS_ROBOT 4 cart.urdf - floating -1",
     "number of active joints -1"},
    {"RobotWithAnUnknownFrozenState", "PARAMS_ROBOT 4 cart.urdf cart.srdf floating 0 frozen asleep",
     "asleep"},
    {"RobotWhoseFrozenStateIsMissing", "PARAMS_ROBOT 4 cart.urdf cart.srdf floating 0 frozen",
     "too few fields"},
    {"RobotOfAnUnknownModel", "PARAMS_ROBOT 4 model centaurus floating 0",
     "unknown robot model 'centaurus', expected one that `locograph list robots` names"},
    {"RobotWhoseModelIsAPath", "PARAMS_ROBOT 4 model ../models/centauro floating 0",
     "unknown robot model '../models/centauro'"},
    {"RobotWithoutTheNameOfItsModel", "PARAMS_ROBOT 4 model", "too few fields"},
    {"RobotWithATakenNumber", "PARAMS_ROBOT 0 cart.urdf - floating 0",
     "parameter 0 is given twice"},
    // Plans of version 1
    {"WheelsOfAnOlderPlan", "PARAMS_WHEELS 4 0 1 wheel 0.1",
     "PARAMS_WHEELS of an older format, expected a plan of format version 3"},
    {"WheelContactOfAnOlderPlan", "EDGE_WHEEL_CONTACT 0 2 1 scalar 1",
     "EDGE_WHEEL_CONTACT of an older format"},
    {"ContactOfAnOlderPlan", "PARAMS_CONTACT 9 0 arm 0 0 0 link 0 0 1 1 0 0 point .5 1",
     "PARAMS_CONTACT of a plan of format version 1"},
    {"PlanOfAnotherVersion", "PARAMS_PLAN 9 1",
     "a plan of format version 1, expected version 2 or 3"},
    {"PlanOfAVersionToCome", "PARAMS_PLAN 9 4", "a plan of format version 4"},
    {"PlanWithAnUnknownWord", "PARAMS_PLAN 9 2 stances", "'stances', expected 'stances_only'"},
    {"PlanWithAWordTwice", "PARAMS_PLAN 9 2 stances_only stances_only", "a second 'stances_only'"},
    {"PlanMovedTwice", "PARAMS_PLAN 9 2 moved_contacts 0.1 3 1 moved_contacts 0.1 3 1",
     "a second 'moved_contacts'"},
    {"PlanMovedByNothing", "PARAMS_PLAN 9 2 moved_contacts 0 3 1", "expected more than 0 m"},
    {"PlanMovedByNoSeed", "PARAMS_PLAN 9 2 moved_contacts 0.1 -3 1", "the seed '-3'"},
    {"PlanMovedByNoDraw", "PARAMS_PLAN 9 2 moved_contacts 0.1 3 0", "draw 0, expected 1 to 20"},
    {"PlanMovedHalf", "PARAMS_PLAN 9 2 moved_contacts 0.1", "too few fields"},
    {"PlanWithHalfAMargin", "PARAMS_PLAN 9 3 execution_margin 0.65 0.65", "too few fields"},
    {"PlanWithAMarginBeyondAll", "PARAMS_PLAN 9 3 execution_margin 1.1 1 1 0 0 0", "friction"},
    {"PlanWithANegativeMargin", "PARAMS_PLAN 9 3 execution_margin 1 1 1 0 -0.1 0", "least_force"},
    {"PlanWithTwoMargins",
     "PARAMS_PLAN 9 3 execution_margin 1 1 1 0 0 1 execution_margin 1 1 1 0 0 1",
     "a second 'execution_margin'"},
    {"PlanWithANegativeSelfDistance",
     "PARAMS_PLAN 9 3 execution_margin 1 1 1 0 0 0 self_distance -0.1", "self_distance_m"},
    {"PlanWithASelfDistanceAlone", "PARAMS_PLAN 9 3 self_distance 0.01", "after that"},
    {"PlanWithTheOtherWordTwice", "PARAMS_PLAN 9 2 incomplete stances_only incomplete",
     "a second 'incomplete'"},
    // Wheels
    {"WheelThatIsNoLink",
     "PARAMS_CONTACT 9 0 w wheal wheel 0.1 0.8 100 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free", "wheal"},
    {"WheelOfRadiusZero",
     "PARAMS_CONTACT 9 0 w wheel wheel 0 0.8 100 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free",
     "radius of 0"},
    {"WheelOfNegativeRadius",
     "PARAMS_CONTACT 9 0 w wheel wheel -0.1 0.8 100 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free",
     "radius of -0.1"},
    {"WheelOfNoRadius",
     "PARAMS_CONTACT 9 0 w wheel wheel nan 0.8 100 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free",
     "'nan' is not finite"},
    {"WheelOnAFixedJoint",
     "PARAMS_CONTACT 9 0 w mast wheel 0.1 0.8 100 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free",
     "wheel that no joint turns"},
    {"WheelOnAPrismaticJoint",
     "PARAMS_CONTACT 9 0 w lift wheel 0.1 0.8 100 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free",
     "wheel that no joint turns"},
    {"WheelThatIsTheBase",
     "PARAMS_CONTACT 9 0 w base wheel 0.1 0.8 100 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free",
     "wheel that no joint turns"},
    {"WheelBesideItsAxle",
     "PARAMS_CONTACT 9 0 w wheel wheel 0.1 0.8 100 0.1 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free",
     "0.100000 m beside its axle"},
    {"ContactFartherThanAnythingIs",
     "PARAMS_CONTACT 9 0 w wheel wheel 0.1 0.8 100 0 0 0 0 0 1 1 0 0 at 0 1e16 0 0 0 1 free",
     "the coordinate 1e16, expected at most 1e+06"},
    {"ContactOfAnAbsurdSize",
     "PARAMS_CONTACT 9 0 w wheel wheel 1e17 0.8 100 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free",
     "the radius 1e17"},
    {"ContactOfAnAbsurdForce",
     "PARAMS_CONTACT 9 0 w wheel wheel 0.1 0.8 1e300 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free",
     "the force 1e300"},
    // PARAMS_STANCE
    {"StanceOfNothing", "PARAMS_STANCE 9 0", "number of contacts 0"},
    {"StanceOfAnUnknownContact", "PARAMS_STANCE 9 1 77", "unknown parameter 77"},
    {"StanceOfAWorld", "PARAMS_STANCE 9 1 2", "parameter 2 is a PARAMS_WORLD"},
    {"StanceWithFewerContactsThanAnnounced", "PARAMS_STANCE 9 2 3", "too few fields"},
    {"StanceOfMillionsOfContacts", "PARAMS_STANCE 9 2000000000 3",
     "number of contacts 2000000000, expected at least one, at most 100"},
    {"StanceWithMoreContactsThanAnnounced", "PARAMS_STANCE 9 1 3 3", "too many fields"},
    {"StanceWithATakenNumber", "PARAMS_STANCE 3 1 3", "parameter 3 is given twice"},
    {"StanceWithAContactTwice", "PARAMS_STANCE 9 2 3 3", "contacts 1 and 2"},
    {"VertexInAnUnknownStance", "VERTEX_CONFIGURATION 9 0 0 77 0 0 0 0 0 0 1 0 0 0",
     "unknown parameter 77"},
    {"VertexInAWorld", "VERTEX_CONFIGURATION 9 0 0 2 0 0 0 0 0 0 1 0 0 0",
     "parameter 2 is a PARAMS_WORLD"},
    // PARAMS_WORLD and PARAMS_SCENARIO
    {"WorldWithoutItsMap", "PARAMS_WORLD 4 nowhere.bt -", "nowhere.bt"},
    {"WorldWithoutItsObstacles", "PARAMS_WORLD 4 - nowhere.xml", "nowhere.xml"},
    {"WorldWithOneFile", "PARAMS_WORLD 4 -", "too few fields"},
    {"WorldOnSomethingElse", "PARAMS_WORLD 4 - - floor 0", "'floor', expected 'ground'"},
    {"WorldOnGroundWithoutHeight", "PARAMS_WORLD 4 - - ground", "too few fields"},
    {"ScenarioWithoutName", "PARAMS_SCENARIO 4", "too few fields"},
    // EDGE_JOINT_LIMITS
    {"JointLimitsWithTooFewRows", "EDGE_JOINT_LIMITS 0 2 0.1 scalar 1",
     "EDGE_JOINT_LIMITS with n = 2, expected n = 3"},
    {"JointLimitsWithTooManyRows", "EDGE_JOINT_LIMITS 0 4000 0.1 scalar 1",
     "EDGE_JOINT_LIMITS with n = 4000, expected n = 3"},
    {"JointLimitsWithNoRows", "EDGE_JOINT_LIMITS 0 0 0.1 scalar 1", "error of size 0"},
    {"JointLimitsWithScalarMisspelt", "EDGE_JOINT_LIMITS 0 3 0.1 scaler 1",
     "weights begin with 'scaler', expected 'scalar' or 'diagonal'"},
    {"JointLimitsWithDiagonalMisspelt", "EDGE_JOINT_LIMITS 0 3 0.1 diagonals 1 1 1",
     "weights begin with 'diagonals'"},
    {"JointLimitsWithoutNoRows", "EDGE_JOINT_LIMITS 0 3 0.1 scalar 1 without 0",
     "0 rows without weight"},
    {"JointLimitsWithoutARowThatIsNone", "EDGE_JOINT_LIMITS 0 3 0.1 scalar 1 without 1 3",
     "row 3 without weight, expected ascending rows, 0 to 2"},
    {"JointLimitsWithoutARowTwice", "EDGE_JOINT_LIMITS 0 3 0.1 scalar 1 without 2 1 1",
     "row 1 without weight"},
    {"JointLimitsWithANegativeWeight", "EDGE_JOINT_LIMITS 0 3 0.1 scalar -1", "a negative weight"},
    {"JointLimitsWithANegativeWeightAmongOthers", "EDGE_JOINT_LIMITS 0 3 0.1 diagonal 1 -2 1",
     "a negative weight"},
    {"JointLimitsWithAnAbsurdWeight", "EDGE_JOINT_LIMITS 0 3 0.1 diagonal 1 1e300 1",
     "the weight 1e300, expected at most 1e30"},
    {"JointLimitsWithANegativeMargin", "EDGE_JOINT_LIMITS 0 3 -0.1 scalar 1",
     "with a margin of -0.1, expected 0 to 1e+06"},
    {"JointLimitsWithTooFewWeights", "EDGE_JOINT_LIMITS 0 3 0.1 diagonal 1 1", "too few fields"},
    {"JointLimitsWithTooManyWeights", "EDGE_JOINT_LIMITS 0 3 0.1 scalar 1 1", "too many fields"},
    {"JointLimitsWithANaNMargin", "EDGE_JOINT_LIMITS 0 3 nan scalar 1", "'nan' is not finite"},
    {"JointLimitsOnAnUnknownVertex", "EDGE_JOINT_LIMITS 5 3 0.1 scalar 1", "unknown vertex 5"},
    // EDGE_VELOCITY_LIMITS
    {"VelocityLimitsWithoutTheRowsOfTheBase", "EDGE_VELOCITY_LIMITS 0 1 3 1 0.5 0.5 scalar 1",
     "EDGE_VELOCITY_LIMITS with n = 3, expected n = 5"},
    {"VelocityLimitsWithANaNWeight", "EDGE_VELOCITY_LIMITS 0 1 5 1 0.5 0.5 scalar nan",
     "'nan' is not finite"},
    {"VelocityLimitsFromAVertexToItself", "EDGE_VELOCITY_LIMITS 0 0 5 1 0.5 0.5 scalar 1",
     "names vertex 0 twice"},
    {"VelocityLimitsWithOneVertex", "EDGE_VELOCITY_LIMITS 0", "too few fields"},
    // EDGE_OBSTACLE_DISTANCE
    {"ObstacleDistanceInAnUnknownWorld", "EDGE_OBSTACLE_DISTANCE 0 3 6 0.1 scalar 1",
     "unknown parameter 6"},
    {"ObstacleDistanceInARobot", "EDGE_OBSTACLE_DISTANCE 0 3 0 0.1 scalar 1",
     "parameter 0 is a PARAMS_ROBOT"},
    {"ObstacleDistanceWithANegativeMargin", "EDGE_OBSTACLE_DISTANCE 0 3 2 -0.1 scalar 1",
     "EDGE_OBSTACLE_DISTANCE with a margin of -0.1"},
    {"ObstacleDistanceWithTooManyRows", "EDGE_OBSTACLE_DISTANCE 0 4 2 0.1 scalar 1",
     "EDGE_OBSTACLE_DISTANCE with n = 4, expected n = 3"},
    {"ObstacleDistanceWithTooFewRows", "EDGE_OBSTACLE_DISTANCE 0 1 2 0.1 scalar 1",
     "EDGE_OBSTACLE_DISTANCE with n = 1, expected n = 3"},
    {"ObstacleDistanceWithAMisspeltWord", "EDGE_OBSTACLE_DISTANCE 0 3 2 0.1 skalar 1",
     "weights begin with 'skalar'"},
    // EDGE_SELF_COLLISION
    {"SelfCollisionWithTooFewRows", "EDGE_SELF_COLLISION 0 2 0.1 scalar 1",
     "EDGE_SELF_COLLISION with n = 2, expected n = 3"},
    {"SelfCollisionWithTooManyRows", "EDGE_SELF_COLLISION 0 4 0.1 scalar 1",
     "EDGE_SELF_COLLISION with n = 4, expected n = 3"},
    {"SelfCollisionWithANaNMargin", "EDGE_SELF_COLLISION 0 3 nan scalar 1", "'nan' is not finite"},
    {"SelfCollisionWithAnAbsurdMargin", "EDGE_SELF_COLLISION 0 3 1e300 scalar 1",
     "with a margin of 1e+300, expected -1e+06 to 1e+06"},
    {"SelfCollisionWithoutMargin", "EDGE_SELF_COLLISION 0 3 scalar 1", "'scalar' is not a number"},
    {"SelfCollisionWithANegativeWeight", "EDGE_SELF_COLLISION 0 3 0.1 diagonal 1 1 -1",
     "a negative weight"},
    {"SelfCollisionOnAnUnknownVertex", "EDGE_SELF_COLLISION 5 3 0.1 scalar 1", "unknown vertex 5"},
    // EDGE_SWEPT_OBSTACLE_DISTANCE
    {"SweptObstacleDistanceInAnUnknownWorld", "EDGE_SWEPT_OBSTACLE_DISTANCE 0 1 3 6 0.1 2 scalar 1",
     "unknown parameter 6"},
    {"SweptObstacleDistanceInARobot", "EDGE_SWEPT_OBSTACLE_DISTANCE 0 1 3 0 0.1 2 scalar 1",
     "parameter 0 is a PARAMS_ROBOT"},
    {"SweptObstacleDistanceWithTooManyRows", "EDGE_SWEPT_OBSTACLE_DISTANCE 0 1 4 2 0.1 2 scalar 1",
     "EDGE_SWEPT_OBSTACLE_DISTANCE with n = 4, expected n = 3"},
    {"SweptObstacleDistanceWithoutSamples", "EDGE_SWEPT_OBSTACLE_DISTANCE 0 1 3 2 0.1 0 scalar 1",
     "number of samples 0, expected 1 to 1000"},
    {"SweptObstacleDistanceWithMillionsOfSamples",
     "EDGE_SWEPT_OBSTACLE_DISTANCE 0 1 3 2 0.1 2000000 scalar 1", "number of samples 2000000"},
    {"SweptObstacleDistanceWithHalfASample",
     "EDGE_SWEPT_OBSTACLE_DISTANCE 0 1 3 2 0.1 0.5 scalar 1", "0.5"},
    {"SweptObstacleDistanceWithANegativeMargin",
     "EDGE_SWEPT_OBSTACLE_DISTANCE 0 1 3 2 -0.1 2 scalar 1",
     "EDGE_SWEPT_OBSTACLE_DISTANCE with a margin of -0.1, expected 0 to 1e+06"},
    {"SweptObstacleDistanceFromAVertexToItself",
     "EDGE_SWEPT_OBSTACLE_DISTANCE 0 0 3 2 0.1 2 scalar 1", "names vertex 0 twice"},
    {"SweptObstacleDistanceWithOneVertex", "EDGE_SWEPT_OBSTACLE_DISTANCE 0", "too few fields"},
    // EDGE_ROLLING
    {"RollingInAnUnknownStance", "EDGE_ROLLING 0 1 2 6 scalar 1", "unknown parameter 6"},
    {"RollingOnAContact", "EDGE_ROLLING 0 1 2 3 scalar 1", "parameter 3 is a PARAMS_CONTACT"},
    {"RollingWithTooFewRows", "EDGE_ROLLING 0 1 1 5 scalar 1",
     "EDGE_ROLLING with n = 1, expected n = 2"},
    {"RollingWithTooManyRows", "EDGE_ROLLING 0 1 3 5 scalar 1",
     "EDGE_ROLLING with n = 3, expected n = 2"},
    {"SteeringSlipOnAContact", "EDGE_STEERING_SLIP 0 1 1 3 0.002 scalar 1",
     "parameter 3 is a PARAMS_CONTACT"},
    {"SteeringSlipWithTooManyRows", "EDGE_STEERING_SLIP 0 1 2 5 0.002 scalar 1",
     "EDGE_STEERING_SLIP with n = 2, expected n = 1"},
    {"SteeringSlipBelowNothing", "EDGE_STEERING_SLIP 0 1 1 5 -0.002 scalar 1",
     "expected 0 m or more"},
    {"RollingWithAMisspeltWord", "EDGE_ROLLING 0 1 2 5 Diagonal 1 1",
     "weights begin with 'Diagonal'"},
    // EDGE_PLAN_TRACKING
    {"PlanTrackingWithTooFewRows", "EDGE_PLAN_TRACKING 0 8 0 0 0 0 0 0 1 0 0 scalar 1",
     "EDGE_PLAN_TRACKING with n = 8, expected n = 9"},
    {"PlanTrackingWithTheReferenceOfAFixedBase",
     "EDGE_PLAN_TRACKING 0 9 0 0 0 0 0 0 1 0 0 scalar 1",
     "reference of EDGE_PLAN_TRACKING with n = 9, expected n = 10"},
    {"PlanTrackingWithATruncatedReference", "EDGE_PLAN_TRACKING 0 9 0 0 0 0 0 0 1 0 scalar 1",
     "'scalar' is not a number"},
    {"PlanTrackingWithTooLongAReference", "EDGE_PLAN_TRACKING 0 9 0 0 0 0 0 0 1 0 0 0 5 scalar 1",
     "weights begin with '5'"},
    {"PlanTrackingWithAZeroQuaternion", "EDGE_PLAN_TRACKING 0 9 0 0 0 0 0 0 0 0 0 0 scalar 1",
     "quaternion of length zero"},
    {"PlanTrackingWithANaN", "EDGE_PLAN_TRACKING 0 9 0 0 0 0 0 0 1 nan 0 0 scalar 1",
     "'nan' is not finite"},
    {"PlanTrackingWithANaNAtTheEnd", "EDGE_PLAN_TRACKING 0 9 0 0 0 0 0 0 1 0 0 nan scalar 1",
     "nan"},
    {"PlanTrackingWithANegativeWeight", "EDGE_PLAN_TRACKING 0 9 0 0 0 0 0 0 1 0 0 0 scalar -1",
     "a negative weight"},
    // EDGE_VELOCITY_TRACKING
    {"VelocityTrackingWithTooFewRows", "EDGE_VELOCITY_TRACKING 0 1 3 1 2 3 scalar 1",
     "EDGE_VELOCITY_TRACKING with n = 3, expected n = 9"},
    {"VelocityTrackingWithTooManyRows",
     "EDGE_VELOCITY_TRACKING 0 1 10 1 2 3 4 5 6 7 8 9 10 scalar 1",
     "EDGE_VELOCITY_TRACKING with n = 10, expected n = 9"},
    {"VelocityTrackingWithATruncatedStep", "EDGE_VELOCITY_TRACKING 0 1 9 1 2 3 4 5 6 7 8 scalar 1",
     "'scalar' is not a number"},
    {"VelocityTrackingWithAMisspeltWord", "EDGE_VELOCITY_TRACKING 0 1 9 1 2 3 4 5 6 7 8 9 scalr 1",
     "weights begin with 'scalr'"},
};

class BadInput : public testing::TestWithParam<BadLine> {
 protected:
  void SetUp() override {
    folder.write("cart.urdf", kCartUrdf);
    folder.write("cart.srdf", kCartSrdf);
  }
  TemporaryFolder folder;
};

TEST_P(BadInput, IsAnErrorWithFileAndLine) { expect_bad_line(folder, kGood, GetParam()); }

INSTANTIATE_TEST_SUITE_P(Plugins, BadInput, testing::ValuesIn(kBadLines), bad_line_name);

TEST(OlderPlans, AreRefusedWhereTheyHaveNoStances) {
  const TemporaryFolder folder;
  folder.write("cart.urdf", kCartUrdf);
  try {
    read_graph(folder.write("plan.g2o",
                            "PARAMS_ROBOT 0 cart.urdf - floating 0\n"
                            "VERTEX_CONFIGURATION 0 0 0 0 0 0 0 0 0 1 0.1 0.2 0.3\n"),
               robot_types());
    FAIL() << "was read";
  } catch (const Error& error) {
    EXPECT_EQ(error.line(), 2);
    EXPECT_NE(std::string(error.what()).find("of a plan of format version 1"), std::string::npos)
        << error.what();
  }
}

TEST(BadFiles, NamedByAPlanAreBlamedThemselves) {
  const TemporaryFolder folder;
  folder.write("cart.urdf", kCartUrdf);
  folder.write("broken.urdf", "<robot name=\"cart\">\n<link>\n</robot>\n");
  folder.write("broken.srdf", "<robot name=\"cart\">\n<group_state group=\"all\"/>\n</robot>\n");
  folder.write("broken.xml", "<obstacles version=\"1\">\n<box center=\"0 0 0\"/>\n</obstacles>\n");
  folder.write("broken.bt", "no map\n");
  const struct {
    const char *line, *file;
  } cases[] = {{"PARAMS_ROBOT 0 broken.urdf - fixed 0", "broken.urdf"},
               {"PARAMS_ROBOT 0 cart.urdf broken.srdf fixed 0", "broken.srdf"},
               {"PARAMS_WORLD 0 - broken.xml", "broken.xml"},
               {"PARAMS_WORLD 0 broken.bt -", "broken.bt"}};
  for (const auto& bad : cases) {
    try {
      read_graph(folder.write("plan.g2o", bad.line), robot_types());
      FAIL() << "was read: " << bad.line;
    } catch (const Error& error) {
      EXPECT_EQ(error.file(), folder.file(bad.file).string()) << error.what();
      EXPECT_GT(error.line(), 0) << error.what();
    }
  }
}

TEST(GoodInput, OfEveryKindIsRead) {
  const TemporaryFolder folder;
  folder.write("cart.urdf", kCartUrdf);
  folder.write("cart.srdf", kCartSrdf);
  const std::filesystem::path plan =
      folder.write("plan.g2o", std::string(kGood) +
                                   "EDGE_JOINT_LIMITS 0 3 0.1 scalar 1\n"
                                   "EDGE_VELOCITY_LIMITS 0 1 5 1 0.5 0.5 scalar 1\n"
                                   "EDGE_OBSTACLE_DISTANCE 0 3 2 0.1 diagonal 1 2 3\n"
                                   "EDGE_SELF_COLLISION 0 3 0.05 diagonal 1 2 3\n"
                                   "EDGE_SWEPT_OBSTACLE_DISTANCE 0 1 3 2 0.1 4 scalar 1\n"
                                   "EDGE_CONTACT 0 2 3 scalar 1\n"
                                   "EDGE_ROLLING 0 1 2 5 scalar 1\n"
                                   "EDGE_PLAN_TRACKING 0 9 0 0 0 0 0 0 2 0 0 -.5 scalar 1\n"
                                   "EDGE_VELOCITY_TRACKING 0 1 9 1 2 3 4 5 6 7 8 9 scalar 0\n");
  const Graph graph = read_graph(plan, robot_types());
  EXPECT_EQ(graph.edge_count(), 9);
  Eigen::VectorXd reference(10);
  reference << 0, 0, 0, 0, 0, 0, 1, 0, 0, -0.5;
  EXPECT_TRUE(graph.edges_of<EdgePlanTracking>()[0].reference == reference)
      << "its quaternion is normalised";
}

/// Two robots in one graph: a cart with three joints, and one whose arm alone moves.
class TwoRobots : public testing::Test {
 protected:
  void SetUp() override {
    folder.write("cart.urdf", kCartUrdf);
    folder.write("cart.srdf", kCartSrdf);
  }
  void expect_refused(const std::string& edge, const std::string& message) {
    const std::string text = std::string(kGood) +
                             "PARAMS_ROBOT 4 cart.urdf - floating 1 arm_joint\n"
                             "VERTEX_CONFIGURATION 2 4 0 - 0 0 0 0 0 0 1 0.1\n"
                             "VERTEX_CONFIGURATION 3 4 1 - 0 0 0 0 0 0 1 0.1\n" +
                             edge + "\n";
    Graph graph = read_graph(folder.write("plan.g2o", text), robot_types());
    Problem problem;
    problem.compile(graph);
    Workspace workspace;
    try {
      workspace.allocate(problem);
      workspace.load_state();
      workspace.evaluate(workspace.state());
      FAIL() << "was evaluated: " << edge;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  }
  TemporaryFolder folder;
};

TEST_F(TwoRobots, AreNotMixedUpByAnEdgeThatFitsTheOtherOne) {
  expect_refused("EDGE_JOINT_LIMITS 2 3 0.1 scalar 1", "EDGE_JOINT_LIMITS with n = 3");
  expect_refused("EDGE_JOINT_LIMITS 0 1 0.1 scalar 1", "EDGE_JOINT_LIMITS with n = 1");
  expect_refused("EDGE_VELOCITY_LIMITS 2 3 5 1 0 0 scalar 1", "EDGE_VELOCITY_LIMITS with n = 5");
  expect_refused("EDGE_SELF_COLLISION 2 3 0.1 scalar 1", "EDGE_SELF_COLLISION with n = 3");
  expect_refused("EDGE_SELF_COLLISION 0 2 0.1 scalar 1", "EDGE_SELF_COLLISION with n = 2");
  expect_refused("EDGE_PLAN_TRACKING 2 9 0 0 0 0 0 0 1 0 0 0 scalar 1",
                 "EDGE_PLAN_TRACKING with n = 9");
  expect_refused("EDGE_PLAN_TRACKING 0 7 0 0 0 0 0 0 1 0 scalar 1",
                 "EDGE_PLAN_TRACKING with n = 7");
  expect_refused("EDGE_VELOCITY_TRACKING 0 1 7 0 0 0 0 0 0 0 scalar 1",
                 "EDGE_VELOCITY_TRACKING with n = 7");
}

TEST_F(TwoRobots, AreNotTiedTogether) {
  const std::string message = "configurations of different robots";
  expect_refused("EDGE_VELOCITY_LIMITS 0 2 5 1 0 0 scalar 1", message);
  expect_refused("EDGE_VELOCITY_LIMITS 2 0 3 1 0 0 scalar 1", message);
  expect_refused("EDGE_VELOCITY_TRACKING 0 2 9 0 0 0 0 0 0 0 0 0 scalar 1", message);
  expect_refused("EDGE_ROLLING 0 2 2 5 scalar 1", message);
  expect_refused("EDGE_SWEPT_OBSTACLE_DISTANCE 0 2 3 2 0.1 2 scalar 1", message);
}

TEST_F(TwoRobots, KeepTheirOwnWheels) {
  expect_refused("EDGE_CONTACT 2 2 3 scalar 1", "configurations of different robots");
  expect_refused("EDGE_ROLLING 2 3 2 5 scalar 1", "configurations of different robots");
}

TEST(EdgesOnly, AreRefusedWhereNoVertexNamesARobot) {
  const TemporaryFolder folder;
  folder.write("cart.urdf", kCartUrdf);
  const std::filesystem::path plan = folder.write(
      "plan.g2o", "PARAMS_ROBOT 0 cart.urdf - floating 0\nEDGE_JOINT_LIMITS 0 3 0.1 scalar 1\n");
  try {
    read_graph(plan, robot_types());
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.line(), 2);
    EXPECT_NE(std::string(error.what()).find("how large vertex 0 is"), std::string::npos)
        << error.what();
  }
}

TEST(EdgesInAGraph, AreRefusedWhenAddedWithTheWrongSize) {
  const RobotCase robot = centauro_lower_body();
  Graph graph = graph_of(robot);
  graph.parameters().set(kWorld, std::make_shared<const WorldParameter>());
  const auto a = add_configuration(graph, robot, 0, 0.0, home(robot));
  const auto b = add_configuration(graph, robot, 1, 1.0, home(robot));
  const Robot& model = robot.model();
  const auto wrong = [](auto edge) {
    edge.weights.setOnes(edge.weights.size() + 1);
    return edge;
  };
  EXPECT_THROW(graph.add_edge(wrong(EdgeJointLimits(model, 0.1, 1.0)), a), Error);
  EXPECT_THROW(graph.add_edge(wrong(EdgeObstacleDistance(*robot.robot, kWorld, 0.1, 1.0)), a),
               Error);
  EXPECT_THROW(graph.add_edge(wrong(EdgeSelfCollision(*robot.robot, 0.1, 1.0)), a), Error);
  EXPECT_THROW(
      graph.add_edge(wrong(EdgeSweptObstacleDistance(*robot.robot, kWorld, 0.1, 2, 1.0)), a, b),
      Error);
  EXPECT_THROW(graph.add_edge(EdgeSweptObstacleDistance(*robot.robot, kWorld, 0.1, 0, 1.0), a, b),
               Error);
  EXPECT_THROW(graph.add_edge(wrong(wheel_contact(graph, 0)), a), Error);
  EXPECT_THROW(graph.add_edge(wrong(EdgePlanTracking(home(robot), Eigen::VectorXd::Ones(30))), a),
               Error);
  EXPECT_THROW(graph.add_edge(EdgePlanTracking(home(robot).head(30), Eigen::VectorXd::Ones(30)), a),
               Error);
  EXPECT_THROW(graph.add_edge(wrong(EdgeVelocityLimits(model, 1.0, 1.0, 1.0, 1.0)), a, b), Error);
  EXPECT_THROW(graph.add_edge(wrong(rolling_of(graph)), a, b), Error);
  EXPECT_THROW(
      graph.add_edge(EdgeVelocityTracking(Eigen::VectorXd::Zero(29), Eigen::VectorXd::Ones(30)), a,
                     b),
      Error);
  EXPECT_EQ(graph.edge_count(), 0);
  EXPECT_THROW(VertexConfiguration(kRobot, robot.robot, 0.0, home(robot).head(30)), Error);
}

}  // namespace
}  // namespace locograph::test
