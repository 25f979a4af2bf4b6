// A kind of contact that a program has added goes through files and edges as any other does.
#include <locograph/common/input_file.h>
#include <locograph/plugins/contact/edge_contact.h>
#include <locograph/plugins/static_balance/edge_balance.h>
#include <locograph/plugins/static_balance/edge_contact_wrench.h>

#include "plugins/bad_line.h"
#include "plugins/small_robot.h"
#include "robots/blade_contact.h"

namespace locograph::test {
namespace {

constexpr const char* kSkatePlan =
    "PARAMS_ROBOT 0 cart.urdf cart.srdf floating 0\n"
    "PARAMS_PLAN 1 3\n"
    "PARAMS_CONTACT 4 0 skate arm blade 0.1 0.5 100 0 0 -0.3 0.1 0 1 1 0 0 at 0.2 0.1 0 0 0.3 1 1 "
    "0 "
    "0 unloaded\n"
    "PARAMS_CONTACT 5 0 skate arm blade 0.1 0.5 100 0 0 -0.3 0.1 0 1 1 0 0 at 0.2 0.1 0 0 0.3 1 1 "
    "0 "
    "0\n"
    "VERTEX_CONFIGURATION 0 0 0 - 0.1 0.2 0.3 0 0 0 1 0.5 0.125 0.3\n"
    "VERTEX_WRENCHES 1 1 5 -70 20 5\n";

class AddedKindInAGraph : public testing::Test {
 protected:
  void SetUp() override {
    blade();
    std::string urdf = kCartUrdf;
    const std::string base = "<link name=\"base\">";
    urdf.insert(urdf.find(base) + base.size(),
                "<inertial><mass value=\"2\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" "
                "iyz=\"0\" izz=\"1\"/></inertial>");
    folder.write("cart.urdf", urdf);
    folder.write("cart.srdf", kCartSrdf);
  }
  Graph read(const std::string& edges) const {
    return read_graph(folder.write("plan.g2o", kSkatePlan + edges), robot_types());
  }
  TemporaryFolder folder;
};

TEST_F(AddedKindInAGraph, IsWrittenAndReadAsTheSameBits) {
  const Graph graph = read("EDGE_CONTACT 0 3 4 scalar 7\nEDGE_CONTACT_WRENCH 1 6 scalar 3\n");
  const auto contact = graph.parameters().get<ContactParameter>(4);
  EXPECT_EQ(contact->kind(), blade());
  EXPECT_EQ(contact->contact.effector.half_y_m, 0.1);
  EXPECT_EQ(contact->contact.effector.friction, 0.5);
  EXPECT_EQ(contact->contact.effector.max_force_N, 100.0);
  EXPECT_FALSE(contact->axes_in_world);
  const std::filesystem::path first = folder.file("first.g2o"), second = folder.file("second.g2o");
  write_graph(graph, first);
  write_graph(read_graph(first, robot_types()), second);
  EXPECT_EQ(read_file(first), read_file(second));
  EXPECT_NE(read_file(first).find("arm blade "), std::string::npos);
}

TEST_F(AddedKindInAGraph, HasEdgesWithItsRows) {
  Graph graph = read(
      "EDGE_CONTACT 0 3 4 scalar 1\nEDGE_CONTACT_WRENCH 1 6 scalar 1\n"
      "EDGE_BALANCE 0 1 scalar 1\n");
  Evaluated evaluated(graph);
  const std::vector<std::string> labels[] = {
      {"skate x", "skate z", "skate blade tilt"},
      {"skate normal force", "skate normal force", "skate friction", "skate friction",
       "skate centre of pressure", "skate centre of pressure"}};
  Problem problem;
  problem.compile(graph);
  for (int pool = 0; pool < 2; ++pool) {
    const EdgePool& edges = *graph.edge_pools()[static_cast<std::size_t>(pool)];
    const Eigen::VectorXd e = evaluated.error(0, pool);
    ASSERT_EQ(e.size(), static_cast<Eigen::Index>(labels[pool].size()));
    EXPECT_GT(e.norm(), 0.0);
    for (int row = 0; row < static_cast<int>(e.size()); ++row) {
      EXPECT_EQ(edges.row_label(problem.edges()[static_cast<std::size_t>(pool)], 0, row).name,
                labels[pool][static_cast<std::size_t>(row)]);
    }
  }
  // The wrench -70 20 5 slips by 60 N and tips by 3 Nm.
  Eigen::VectorXd slips(6);
  slips << 0, 0, 0, 60, 3, 0;
  EXPECT_LT((evaluated.error(0, 1) - slips).norm(), 1e-12);
  for (const auto& [pool, slots] : {std::pair(0, 1), std::pair(1, 1), std::pair(2, 2)}) {
    for (int slot = 0; slot < slots; ++slot) {
      const Eigen::MatrixXd numeric = evaluated.jacobian(0, slot, true, pool);
      EXPECT_LT((evaluated.jacobian(0, slot, false, pool) - numeric).norm(),
                1e-5 * (1.0 + numeric.norm()))
          << "pool " << pool << ", vertex " << slot;
    }
  }
}

TEST_F(AddedKindInAGraph, HasLinesThatAreRefused) {
  for (const BadLine& bad :
       {BadLine{"BladeWithoutLength",
                "PARAMS_CONTACT 9 0 \"\" arm blade 0 .5 1 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 1 0 0",
                "half size y"},
        BadLine{"BladeOfAHugeLength",
                "PARAMS_CONTACT 9 0 \"\" arm blade 1e9 .5 1 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 1 0 0",
                "the size 1e9"},
        BadLine{"BladeWithoutForward",
                "PARAMS_CONTACT 9 0 \"\" arm blade 1 .5 1 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free",
                "blade without forward"},
        BadLine{"ClosureOfAnotherSize", "EDGE_CONTACT 0 2 4 scalar 1", "n = 2"}}) {
    expect_bad_line(folder, kSkatePlan, bad);
  }
}

}  // namespace
}  // namespace locograph::test
