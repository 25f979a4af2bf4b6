// What was measured when a plan was carried out, written and read.
#include <locograph/core/graph_file.h>
#include <locograph/planners/plan/record.h>
#include <locograph/plugins/record/edge_measurement.h>
#include <locograph/plugins/robot_types.h>
#include <locograph/plugins/static_balance/static_rows.h>

#include "planners/planned_drive.h"

namespace locograph {
namespace {

TypeRegistry record_types() {
  TypeRegistry types;
  add_robot_types(types);
  return types;
}

/// A drive of five configurations, from which the robot is off by a little.
class RecordTest : public testing::Test {
 protected:
  RecordTest() : graph(planned_drive(centauro_drive(0.32, 0.0, 5))), plan(plan_of(graph)) {
    const Robot& robot = *plan.robot->robot;
    record.motion = motion_of(graph, plan);
    record.motion.wrenches.clear();
    record.plan_file = folder.file("plans/drive.g2o");
    for (std::size_t i = 0; i < plan.slots.size(); ++i) {
      record.plan_time_s.push_back(record.motion.time_s[i]);
      record.motion.time_s[i] = record.motion.time_s[i] * 1.1 + 1.0 / 3.0;
      record.planned.push_back(record.motion.configurations[i]);
      Eigen::VectorXd off = Eigen::VectorXd::Zero(robot.tangent_size()), q = record.planned.back();
      off[0] = 0.003;
      off[robot.base_tangent_size() + kJoint] = -0.01 * static_cast<double>(i);
      robot.integrate(record.planned.back().data(), off.data(), q.data());
      record.motion.configurations[i] = q;
      record.motion.slopes[i] = Eigen::VectorXd::Constant(robot.tangent_size(), 1.0 / 7.0);
      record.torques.emplace_back(Eigen::VectorXd::Constant(robot.active_joint_count(), 1.0 / 9.0));
      record.torques.back()[kJoint] = 0.5 * robot.active_joint(kJoint).max_effort;
      StanceWrenches& wrenches = record.motion.wrenches.emplace_back();
      const Stance& stance =
          record.motion.stances[static_cast<std::size_t>(record.motion.stance_from[i])];
      for (std::size_t c = 0; c < stance.contacts.size(); ++c) {
        wrenches.emplace_back() << 0.1 / 3.0, -2.0, 100.0 * static_cast<double>(c + 1), 0, 0, 0;
      }
    }
  }

  static constexpr int kJoint = 1;
  const TemporaryFolder folder;
  const Graph graph;
  const Plan plan;
  Record record;
};

TEST_F(RecordTest, ComesBackFromItsFileToTheLastBit) {
  std::filesystem::create_directories(folder.file("results"));
  const std::filesystem::path file = folder.file("results/drive.g2o");
  write_graph(record_graph(graph, plan, record), file);
  const Graph read = read_graph(file, record_types());
  const Plan again = plan_of(read);
  EXPECT_TRUE(again.recorded);
  EXPECT_FALSE(plan.recorded);
  EXPECT_NE(again.world, nullptr);
  EXPECT_EQ(read.parameters().find<ScenarioParameter>()->scenario, "centauro_drive");
  const Record got = record_of(read, again);
  EXPECT_EQ(got.plan_file.lexically_normal(), folder.file("plans/drive.g2o"));
  EXPECT_EQ(got.plan_time_s, record.plan_time_s);
  EXPECT_EQ(got.motion.time_s, record.motion.time_s);
  EXPECT_EQ(got.motion.stance_from, record.motion.stance_from);
  ASSERT_EQ(got.planned.size(), record.planned.size());
  for (std::size_t i = 0; i < record.planned.size(); ++i) {
    EXPECT_EQ(got.motion.configurations[i], record.motion.configurations[i]);
    EXPECT_EQ(got.motion.slopes[i], record.motion.slopes[i]);
    EXPECT_EQ(got.planned[i], record.planned[i]);
    EXPECT_EQ(got.torques[i], record.torques[i]);
    ASSERT_EQ(got.motion.wrenches[i].size(), record.motion.wrenches[i].size());
    for (std::size_t c = 0; c < record.motion.wrenches[i].size(); ++c) {
      EXPECT_EQ(got.motion.wrenches[i][c], record.motion.wrenches[i][c]);
    }
  }
  EXPECT_NE(write_graph_text(read, file.parent_path()).find("PARAMS_RECORD 6 ../plans/drive.g2o"),
            std::string::npos);
}

TEST_F(RecordTest, TellsHowFarTheRobotWasOffAndTheLargestTorque) {
  const Robot& robot = *plan.robot->robot;
  const TrackingErrors errors = tracking_errors(robot, record);
  EXPECT_NEAR(errors.most_base_m, 0.003, 1e-12);
  EXPECT_NEAR(errors.most_joint_rad, 0.04, 1e-12);
  EXPECT_EQ(errors.worst_joint, robot.active_joint(kJoint).name);
  EXPECT_NEAR(worst_torque(robot, record).ratio, 0.5, 1e-12);
  EXPECT_EQ(worst_torque(robot, record).joint, robot.active_joint(kJoint).name);
}

TEST_F(RecordTest, HasAnErrorThatIsWhatTorquesDoBesideHoldingTheRobotStill) {
  const Graph written = record_graph(graph, plan, record);
  const EdgeMeasurement& edge = written.edges_of<EdgeMeasurement>().front();
  const VertexConfiguration& vertex =
      written.vertex(VertexId<VertexConfiguration>{edge.vertices[0]});
  const VertexWrenches& wrenches = written.vertex(VertexId<VertexWrenches>{edge.vertices[1]});
  ConfigurationState q = vertex.make_derived();
  vertex.derive(vertex.state.data(), q);
  const WrenchesState state = wrenches.make_derived();
  Eigen::VectorXd still(edge.dimension()), error(edge.dimension());
  static_torques(q.kinematics, state, still);
  edge.error(q, state, error);
  EXPECT_LT((error - (record.torques.front() - still)).norm(), 1e-12);
}

TEST_F(RecordTest, IsRefusedWhereSomethingIsMissing) {
  EXPECT_THROW(record_of(graph, plan), Error);
  Graph lacking = record_graph(graph, plan, record);
  for (int edge = 0; edge < lacking.edge_slots(); ++edge) {
    if (lacking.edge_vertices(edge).size() != 2) continue;
    lacking.remove_edge(EdgeId{edge});
    break;
  }
  try {
    record_of(lacking, plan_of(lacking));
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("configuration 0 of a record without torques"),
              std::string::npos)
        << error.what();
  }
  record.torques.pop_back();
  EXPECT_THROW(record_graph(graph, plan, record), Error);
}

TEST_F(RecordTest, NamesTheLineOfBadInput) {
  const std::string text = write_graph_text(record_graph(graph, plan, record), folder.path());
  const auto message = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    try {
      read_graph_text(changed, "r.g2o", folder.path(), record_types());
    } catch (const Error& error) {
      EXPECT_GT(error.line(), 0) << error.what();
      return std::string(error.what());
    }
    return std::string("read");
  };
  EXPECT_NE(message(" recorded", " recorded recorded").find("a second 'recorded'"),
            std::string::npos);
  EXPECT_NE(message(" recorded", " recorded stances_only").find("a record of stances only"),
            std::string::npos);
  const std::size_t at = text.find("EDGE_MEASUREMENT");
  const std::string line = text.substr(at, text.find('\n', at) - at);
  const std::string start =
      line.substr(0, line.find(' ', line.find(' ', line.find(' ', line.find(' ') + 1) + 1) + 1));
  EXPECT_NE(message(start + " ", start + " -1").find("of a plan's time"), std::string::npos);
}

}  // namespace
}  // namespace locograph
