// Surfaces, bars and boxes keep links away that do not touch them.
#include <locograph/common/input_file.h>
#include <locograph/common/thread_pool.h>
#include <locograph/plugins/surface_distance/edge_surface_distance.h>

#include <cstring>

#include "common/allocation_counter.h"
#include "plugins/bad_line.h"
#include "plugins/jacobian_comparison.h"

namespace locograph::test {
namespace {

/// Three balls on a ball: two feet, which stand on z = 0 when the base is 0.7 m above it, and a
/// hand.
constexpr const char* kWalkerUrdf = R"(<robot name="walker">
  <link name="base"><collision><geometry><sphere radius="0.2"/></geometry></collision></link>
  <link name="hand"><collision><origin xyz="0.2 0 0"/>
    <geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="left"><collision><origin xyz="0 0 -0.3"/>
    <geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="right"><collision><origin xyz="0 0 -0.3"/>
    <geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="arm" type="revolute"><parent link="base"/><child link="hand"/>
    <origin xyz="0.3 0 0.2"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
  <joint name="left_hip" type="revolute"><parent link="base"/><child link="left"/>
    <origin xyz="0 0.2 -0.3"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
  <joint name="right_hip" type="revolute"><parent link="base"/><child link="right"/>
    <origin xyz="0 -0.2 -0.3"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
</robot>
)";

constexpr int kPlaces = 30, kBoth = 20, kOnLeft = 21, kOnRight = 22;
constexpr double kAway_m = 0.05, kFoot_m = 0.1;
/// How deep a link may be in what it touches before and after.
constexpr double kDeepest_m = 0.011;

Eigen::Isometry3d tilted(const Eigen::Vector3d& at, double angle) {
  return Eigen::Translation3d(at) *
         Eigen::AngleAxisd(angle, Eigen::Vector3d(0.36, 0.48, 0.8).normalized());
}

/// A ground without an end, a bar and a box.
World yard() {
  World world;
  world.surfaces = {ground()};
  world.bars = {
      {.name = "rail", .from = {0.5, -0.3, 0.9}, .to = {0.7, 0.4, 1.0}, .radius_m = 0.02}};
  world.solids = {{.name = "a block",
                   .world_from_box = tilted({-0.5, 0.2, 0.5}, 0.7),
                   .size_m = {0.3, 0.2, 0.4}}};
  return world;
}

class SurfaceDistance : public testing::Test {
 protected:
  SurfaceDistance()
      : robot{"Walker",
              std::make_shared<const RobotParameter>(folder.write("walker.urdf", kWalkerUrdf),
                                                     std::filesystem::path(), RobotOptions())} {}

  static Contact foot(const std::string& link, double y) {
    Contact contact;
    contact.effector = {.link = link,
                        .kind = ContactKind::kPoint,
                        .point = {0.0, 0.0, -0.3},
                        .radius_m = kFoot_m,
                        .friction = 0.5,
                        .max_force_N = 100.0};
    contact.position = {0.0, y, 0.0};
    return contact;
  }
  /// With stances on both feet and on each.
  Graph graph_in(const World& world) const {
    Graph graph = graph_of(robot);
    Parameters& parameters = graph.parameters();
    parameters.set(
        10, std::make_shared<const ContactParameter>(robot.robot, kRobot, foot("left", 0.2)));
    parameters.set(
        11, std::make_shared<const ContactParameter>(robot.robot, kRobot, foot("right", -0.2)));
    parameters.set(kBoth,
                   std::make_shared<const StanceParameter>(parameters, std::vector<int>{10, 11}));
    parameters.set(kOnLeft,
                   std::make_shared<const StanceParameter>(parameters, std::vector<int>{10}));
    parameters.set(kOnRight,
                   std::make_shared<const StanceParameter>(parameters, std::vector<int>{11}));
    parameters.set(kPlaces, std::make_shared<const PlacesParameter>(robot.robot, kRobot, world));
    return graph;
  }
  EdgeSurfaceDistance edge(int before = kBoth, int after = kBoth,
                           const std::vector<int>& near = {}) const {
    return EdgeSurfaceDistance(*robot.robot, kPlaces, before, after, kAway_m, 1.0, near);
  }
  Eigen::VectorXd error(const World& world, const Eigen::VectorXd& q, int before = kBoth,
                        int after = kBoth, const std::vector<int>& near = {}) const {
    Graph graph = graph_in(world);
    graph.add_edge(edge(before, after, near), add_configuration(graph, robot, 0, 0.0, q));
    return Evaluated(graph).error(0);
  }
  /// Upright, with the base at this height.
  Eigen::VectorXd standing(double z = 0.7) const {
    Eigen::VectorXd q = robot.model().neutral_configuration();
    q[2] = z;
    return q;
  }
  int row_of(const std::string& link) const {
    const std::vector<RobotParameter::LinkBound>& bounds = robot.robot->bounds;
    const auto found =
        std::ranges::find(bounds, robot.model().link_index(link), &RobotParameter::LinkBound::link);
    return static_cast<int>(found - bounds.begin());
  }
  /// Of the one ball of a link.
  Eigen::Vector3d centre(int row, const Eigen::VectorXd& q) const {
    ConfigurationState state(robot.robot);
    state.update(q.data());
    return state.sphere_centre(robot.robot->bounds[static_cast<std::size_t>(row)].begin);
  }
  double radius(int row) const {
    return robot.robot
        ->spheres[static_cast<std::size_t>(
            robot.robot->bounds[static_cast<std::size_t>(row)].begin)]
        .radius;
  }
  bool is_foot(int row) const { return row == row_of("left") || row == row_of("right"); }

  /// What a ball lacks to the yard, most first, by exact distances of shapes.
  std::vector<double> lacks(int row, const Eigen::VectorXd& q) const {
    const World world = yard();
    const Eigen::Vector3d at = centre(row, q);
    const Eigen::Isometry3d pose(Eigen::Translation3d{at});
    const ConvexShape ball = ConvexShape::sphere(radius(row));
    const Bar& rail = world.bars[0];
    const Eigen::Isometry3d world_from_rail =
        Eigen::Translation3d(0.5 * (rail.from + rail.to)) *
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), rail.to - rail.from);
    const double above = at.z() - radius(row);
    std::vector<double> all = {
        is_foot(row) ? -(above + kDeepest_m) : kAway_m - above,
        kAway_m - shape_distance(ball, pose,
                                 ConvexShape::capsule(rail.radius_m, (rail.to - rail.from).norm()),
                                 world_from_rail)
                      .distance,
        kAway_m - shape_distance(ball, pose, ConvexShape::box(world.solids[0].size_m),
                                 world.solids[0].world_from_box)
                      .distance};
    std::ranges::sort(all, std::greater());
    return all;
  }

  TemporaryFolder folder;
  RobotCase robot;
};

TEST_F(SurfaceDistance, IsWhatTheMarginLacksToTheNearestPlace) {
  Random random(171);
  int violated = 0, held = 0;
  for (int i = 0; i < 200; ++i) {
    Eigen::VectorXd q = random.configuration(robot.model(), 0.6, 0.0);
    q[2] += 0.7;
    const Eigen::VectorXd e = error(yard(), q);
    ASSERT_EQ(e.size(), 4);
    for (int row = 0; row < e.size(); ++row) {
      EXPECT_NEAR(e[row], std::max(0.0, lacks(row, q).front()), 1e-9);
      (e[row] > 0.0 ? violated : held) += 1;
    }
  }
  EXPECT_GT(violated, 60);
  EXPECT_GT(held, 200);
}

TEST_F(SurfaceDistance, TheDistancesOfBallsAreThoseOfTheShapes) {
  const World world = yard();
  const TouchablePlaces places(robot.robot, world);
  ASSERT_EQ(places.size(), 3);
  const ConvexShape ball = ConvexShape::sphere(0.03);
  const SolidBox& block = world.solids[0];
  Random random(172);
  for (int i = 0; i < 500; ++i) {
    Eigen::Isometry3d pose = block.world_from_box;
    pose.translation() += random.vector(3, 0.4);
    const TouchablePlaces::Distance found = places.distance(2, pose.translation(), 0.03);
    const double exact =
        shape_distance(ball, pose, ConvexShape::box(block.size_m), block.world_from_box).distance;
    EXPECT_NEAR(found.value, exact, 1e-9);
    EXPECT_NEAR(found.gradient.norm(), 1.0, 1e-9);
  }
  EXPECT_EQ(places.name(1), "rail");
  EXPECT_EQ(places.name(2), block.name);
}

TEST_F(SurfaceDistance, HasTheJacobianOfNumericDifferences) {
  Random random(173);
  Graph graph = graph_in(yard());
  std::vector<Eigen::VectorXd> all;
  for (int i = 0; i < kStates; ++i) {
    all.push_back(random.configuration(robot.model(), 0.6, 0.0));
    all.back()[2] += 0.7;
    graph.add_edge(edge(), add_configuration(graph, robot, i, 0.0, all.back()));
  }
  Evaluated evaluated(graph);
  Compared compared;
  for (int k = 0; k < kStates; ++k) {
    const Eigen::VectorXd& q = all[static_cast<std::size_t>(k)];
    compare(
        evaluated, k, 0,
        [&](int row) {
          const std::vector<double> lack = lacks(row, q);
          // Where another place becomes the nearest; on an axis and in a box ways out change.
          return std::abs(lack[0]) > kKink && lack[0] - lack[1] > kKink &&
                 lack[0] < kAway_m + 0.9 * radius(row);
        },
        compared);
  }
  EXPECT_GT(compared.nonzero, 0);
  EXPECT_GT(compared.zero, 0);
}

TEST_F(SurfaceDistance, LinksThatTouchMayBeInThePlaceAsDeepAsTheJudgeAllows) {
  World world;
  world.surfaces = {ground()};
  const Eigen::VectorXd e = error(world, standing());
  EXPECT_TRUE(e.isZero(0.0)) << e.transpose();
  // 2 mm deep on both feet is allowed while both are held; a foot that does not touch keeps away.
  constexpr double kDeep_m = 2e-3;
  const Eigen::VectorXd deep = standing(0.7 - kDeep_m);
  EXPECT_TRUE(error(world, deep).isZero(0.0));
  const Eigen::VectorXd on_left = error(world, deep, kOnLeft, kOnLeft);
  EXPECT_EQ(on_left[row_of("left")], 0.0);
  // Spheres cover with room to spare.
  EXPECT_NEAR(on_left[row_of("right")], kAway_m + kDeep_m, 1e-9);
  EXPECT_EQ(on_left[row_of("hand")], 0.0);
  const Eigen::VectorXd deeper = error(world, standing(0.7 - 0.02));
  EXPECT_NEAR(deeper[row_of("left")], 0.02 - kDeepest_m, 1e-12);
}

TEST_F(SurfaceDistance, BetweenTwoStancesAFootThatLiftsMayTouchAndNotReachIn) {
  World world;
  world.surfaces = {ground()};
  constexpr double kDeep_m = 2e-3;
  for (const bool lifts : {true, false}) {
    const int before = lifts ? kBoth : kOnLeft, after = lifts ? kOnLeft : kBoth;
    EXPECT_NEAR(error(world, standing(), before, after).maxCoeff(), 0.0, 1e-12);
    const Eigen::VectorXd e = error(world, standing(0.7 - kDeep_m), before, after);
    EXPECT_EQ(e[row_of("left")], 0.0) << "held before and after";
    EXPECT_NEAR(e[row_of("right")], kDeep_m, 1e-12);
  }
  // From one foot to the other there is no stance between.
  EXPECT_THROW(error(world, standing(), kOnLeft, kOnRight), Error);
}

TEST_F(SurfaceDistance, AFootThatHasJustLeftItsPlaceIsKeptOutOfItWithoutTheMargin) {
  World world;
  world.surfaces = {ground()};
  constexpr double kUp_m = 1e-3, kDeep_m = 2e-3, kOff_m = 2e-4;
  const int right = row_of("right");
  EXPECT_EQ(error(world, standing(0.7 + kUp_m), kOnLeft, kOnLeft, {11})[right], 0.0);
  EXPECT_NEAR(error(world, standing(0.7 - kDeep_m), kOnLeft, kOnLeft, {11})[right],
              kDeep_m + kOff_m, 1e-12);
  EXPECT_THROW(error(world, standing(), kBoth, kBoth, {11}), Error) << "it is closed";
}

TEST_F(SurfaceDistance, APlateIsInTheWayFromBothSides) {
  World world;
  world.surfaces = {{.name = "table",
                     .world_from_surface =
                         Eigen::Isometry3d(Eigen::Translation3d(Eigen::Vector3d(0.5, 0.0, 0.9))),
                     .half_x_m = 0.3,
                     .half_y_m = 0.6}};
  // The hand's ball is at the plate's height less 0.02, 0.2 m inside its edge.
  const Eigen::VectorXd q = standing(0.68);
  const int hand = row_of("hand");
  ASSERT_NEAR(centre(hand, q).z(), 0.88, 1e-12);
  EXPECT_NEAR(error(world, q)[hand], kAway_m + radius(hand) + 0.02, 1e-12);
  // Beside the plate the way is that to its edge.
  world.surfaces[0].world_from_surface.translation().x() = 0.5 - 0.3 - 0.12;
  EXPECT_NEAR(error(world, q)[hand], kAway_m + radius(hand) - std::hypot(0.5 - 0.38, 0.02), 1e-12);
}

TEST_F(SurfaceDistance, SaysWhichLinkIsNearAndHowExactlyItIsMeant) {
  Graph graph = graph_in(yard());
  graph.add_edge(edge(), add_configuration(graph, robot, 0, 0.0, standing()));
  Problem problem;
  problem.compile(graph);
  const EdgePool& pool = *graph.edge_pools()[0];
  EXPECT_EQ(pool.constraint(), ConstraintKind::kInequality);
  const int hand = row_of("hand"), left = row_of("left");
  EXPECT_EQ(pool.row_label(problem.edges()[0], 0, hand).name, "hand near a surface, bar or box");
  EXPECT_EQ(pool.row_label(problem.edges()[0], 0, hand).unit, "m");
  EXPECT_NEAR(pool.row_tolerance(problem.edges()[0], 0, hand), 0.9 * kAway_m, 1e-12);
  EXPECT_LT(pool.row_tolerance(problem.edges()[0], 0, left), 1e-3);
}

TEST_F(SurfaceDistance, ComesBackFromAFileWithTheSameBits) {
  World world = yard();
  world.surfaces.push_back({.name = "a \"step\"",
                            .world_from_surface = tilted({0.1, 0.3, 1.0 / 3.0}, 1.0 / 7.0),
                            .half_x_m = 0.2 / 3.0});
  Random random(174);
  Graph graph = graph_in(world);
  EdgeSurfaceDistance one = edge(kOnLeft, kOnLeft, {11});
  one.margin_m = 0.5 / 3.0;
  one.weights = random.weights(one.weights.size());
  for (int i = 0; i < 20; ++i) {
    Eigen::VectorXd q = random.configuration(robot.model(), 0.6, 0.0);
    q[2] += 0.7;
    graph.add_edge(one, add_configuration(graph, robot, i, 0.0, q));
  }
  write_graph(graph, folder.file("plan.g2o"));
  Graph again = read_graph(folder.file("plan.g2o"), robot_types());
  write_graph(again, folder.file("again.g2o"));
  EXPECT_EQ(read_file(folder.file("plan.g2o"), 1 << 20, "a plan"),
            read_file(folder.file("again.g2o"), 1 << 20, "a plan"));
  Evaluated first(graph), second(again);
  double sum = 0.0;
  for (int k = 0; k < 20; ++k) {
    const Eigen::VectorXd a = first.error(k), b = second.error(k);
    EXPECT_EQ(std::memcmp(a.data(), b.data(), sizeof(double) * 4), 0);
    sum += a.sum();
  }
  EXPECT_GT(sum, 0.1);
}

/// Configurations anywhere in the yard.
class ManySurfaceDistances : public SurfaceDistance {
 protected:
  Graph graph_of_many(int count) const {
    Random random(175);
    Graph graph = graph_in(yard());
    EdgeSurfaceDistance one = edge();
    one.bind(graph.parameters());
    for (int i = 0; i < count; ++i) {
      Eigen::VectorXd q = random.configuration(robot.model(), 0.6, 0.0);
      q[2] += 0.7;
      graph.add_edge(one, add_configuration(graph, robot, i, 0.0, q));
    }
    return graph;
  }
};

TEST_F(ManySurfaceDistances, DoNotAllocate) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  Graph graph = graph_of_many(100);
  Loaded loaded(graph);
  const long before = allocation_count();
  loaded.workspace.evaluate(loaded.workspace.state());
  const Cost cost = loaded.workspace.linearise();
  EXPECT_EQ(allocation_count(), before);
  EXPECT_GT(cost.chi2, 0.1);
}

TEST_F(ManySurfaceDistances, AtOnceEqualOneByOne) {
  Graph graph = graph_of_many(30);
  Loaded loaded(graph);
  EXPECT_GT(expect_batch_equals_one_by_one(loaded.workspace, 1e-12).gradient.norm(), 0.1);
}

TEST_F(ManySurfaceDistances, AreTheSameBitsOnTwoThreads) {
  Graph graph = graph_of_many(1500);
  ThreadPool two(2);
  Problem problem;
  problem.compile(graph);
  EXPECT_GT(problem.chunks(), 1);
  Workspace alone, shared;
  shared.use_threads(&two);
  for (Workspace* workspace : {&alone, &shared}) {
    workspace->allocate(problem);
    workspace->load_state();
    workspace->evaluate(workspace->state());
    workspace->linearise();
  }
  EXPECT_TRUE(std::ranges::equal(alone.hessian(), shared.hessian()));
  EXPECT_TRUE(std::ranges::equal(alone.gradient(), shared.gradient()));
}

constexpr const char* kGoodPlaces =
    "PARAMS_ROBOT 0 walker.urdf - floating 0\n"
    "PARAMS_PLAN 1 3\n"
    "PARAMS_CONTACT 10 0 \"\" left point 0.1 0.5 100 0 0 -0.3 0 0 1 1 0 0 at 0 0.2 0 0 0 1 free\n"
    "PARAMS_CONTACT 11 0 \"\" right point 0.1 0.5 100 0 0 -0.3 0 0 1 1 0 0 at 0 -0.2 0 0 0 1 free\n"
    "PARAMS_STANCE 20 1 10\n"
    "PARAMS_STANCE 21 1 11\n"
    "PARAMS_PLACES 30 0 surface floor 0 0 0 0 0 0 1 endless endless "
    "bar rail 0 0 1 0 1 1 0.02 solid block 1 0 0 0 0 0 1 0.1 0.1 0.1\n"
    "VERTEX_CONFIGURATION 0 0 0 - 0 0 0.7 0 0 0 1 0 0 0\n"
    "EDGE_SURFACE_DISTANCE 0 4 30 20 20 0.05 1 11 scalar 1\n";

const BadLine kBadPlaces[] = {
    {"PlacesOfAnUnknownRobot", "PARAMS_PLACES 9 77", "unknown parameter 77"},
    {"PlacesOfAnotherKind", "PARAMS_PLACES 9 0 hole pit 0 0 0",
     "place 'hole', expected 'surface', 'bar', 'solid' or the end of the line"},
    {"SurfaceWithAZeroQuaternion", "PARAMS_PLACES 9 0 surface floor 0 0 0 0 0 0 0 1 1",
     "quaternion of length zero"},
    {"SurfaceWithoutSize", "PARAMS_PLACES 9 0 surface floor 0 0 0 0 0 0 1 1", "too few fields"},
    {"SurfaceOfNegativeSize", "PARAMS_PLACES 9 0 surface floor 0 0 0 0 0 0 1 1 -1",
     "half a surface of -1 m"},
    {"SurfaceBeyondEverything", "PARAMS_PLACES 9 0 surface floor 0 0 1e7 0 0 0 1 1 1",
     "a place further away than anything"},
    {"BarWithoutLength", "PARAMS_PLACES 9 0 bar rail 1 0 0 1 0 0 0.1", "a bar without length"},
    {"BarBeyondEverything", "PARAMS_PLACES 9 0 bar rail 1e7 0 0 1 0 0 0.1",
     "a coordinate of 1e7 m"},
    {"BarWithoutRadius", "PARAMS_PLACES 9 0 bar rail 0 0 0 1 0 0 0", "the radius of 0 m"},
    {"SolidWithANaNSize", "PARAMS_PLACES 9 0 solid block 0 0 0 0 0 0 1 1 nan 1",
     "'nan' is not finite"},
    {"EdgeWithoutItsPlaces", "EDGE_SURFACE_DISTANCE 0 4 31 20 20 0.05 0 scalar 1",
     "unknown parameter 31"},
    {"EdgeOfARobot", "EDGE_SURFACE_DISTANCE 0 4 0 20 20 0.05 0 scalar 1",
     "parameter 0 is a PARAMS_ROBOT"},
    {"EdgeOfAnUnknownStance", "EDGE_SURFACE_DISTANCE 0 4 30 25 20 0.05 0 scalar 1",
     "unknown parameter 25"},
    {"EdgeOfStancesWithoutACommonContact", "EDGE_SURFACE_DISTANCE 0 4 30 20 21 0.05 0 scalar 1",
     "without a common contact"},
    {"EdgeWithTooFewRows", "EDGE_SURFACE_DISTANCE 0 3 30 20 20 0.05 0 scalar 1", "n = 4"},
    {"EdgeWithACountBelowZero", "EDGE_SURFACE_DISTANCE 0 4 30 20 20 0.05 -1 scalar 1",
     "number of contacts -1"},
    {"EdgeNearWhatItHasClosed", "EDGE_SURFACE_DISTANCE 0 4 30 20 20 0.05 1 10 scalar 1",
     "'left' both closed and near"},
    {"EdgeWithANaNMargin", "EDGE_SURFACE_DISTANCE 0 4 30 20 20 nan 0 scalar 1",
     "'nan' is not finite"},
    {"EdgeWithANegativeMargin", "EDGE_SURFACE_DISTANCE 0 4 30 20 20 -0.05 0 scalar 1",
     "EDGE_SURFACE_DISTANCE with a margin of -0.05, expected 0 to 1e+06"},
    {"EdgeWithAnAbsurdMargin", "EDGE_SURFACE_DISTANCE 0 4 30 20 20 1e9 0 scalar 1",
     "with a margin of 1e+09"},
    {"EdgeWithANegativeWeight", "EDGE_SURFACE_DISTANCE 0 4 30 20 20 0.05 0 scalar -1",
     "a negative weight"},
    {"EdgeWithAnAbsurdWeight", "EDGE_SURFACE_DISTANCE 0 4 30 20 20 0.05 0 scalar 1e99",
     "the weight 1e99, expected at most 1e30"},
    {"EdgeWithoutWeights", "EDGE_SURFACE_DISTANCE 0 4 30 20 20 0.05 0", "too few fields"},
};

class BadPlaces : public testing::TestWithParam<BadLine> {};

TEST_P(BadPlaces, AreAnErrorWithFileAndLine) {
  const TemporaryFolder folder;
  folder.write("walker.urdf", kWalkerUrdf);
  expect_bad_line(folder, kGoodPlaces, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Lines, BadPlaces, testing::ValuesIn(kBadPlaces), bad_line_name);

}  // namespace
}  // namespace locograph::test
