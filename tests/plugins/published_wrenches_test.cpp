// The contact wrenches published for postures of COMAN+, and wrenches eliminated from a plan.
#include <locograph/core/optimiser.h>
#include <locograph/solvers/linear_solvers.h>

#include "plugins/static_balance_test_support.h"
#include "robots/coman_plus_postures.h"

namespace locograph::test::balance {
namespace {

TEST(Wrenches, AreEliminatedWithoutChangingTheSolution) {
  const RobotCase robot = robot_case("ComanPlus");
  const ComanPosture posture = coman_postures()[1];
  const auto solve = [&](const char* solver, bool eliminate, Eigen::MatrixXd& result) {
    Graph graph = graph_of(robot);
    RobotState state(robot.model());
    state.update(posture.configuration().data());
    std::vector<Contact> contacts;
    for (const ComanContact& at : posture.contacts) {
      // All of them level, whichever way the link lies there.
      Contact contact = sole();
      contact.effector.link = at.frame;
      const Eigen::Matrix3d link_from_world =
          state.world_from_link(robot.model().link_index(at.frame)).linear().transpose();
      contact.effector.normal = link_from_world * contact.normal;
      contact.effector.forward = link_from_world * *contact.forward;
      contact.effector.kind =
          at.frame.ends_with("sole") ? ContactKind::kSurface : ContactKind::kPoint;
      contacts.push_back(contact);
    }
    const std::vector<int> numbers = add_contacts(graph, robot, contacts);
    const Robot& model = robot.model();
    Random random(11);
    std::vector<VertexId<VertexConfiguration>> q;
    Eigen::VectorXd at = posture.configuration();
    for (int i = 0; i < 3; ++i) {
      const Eigen::VectorXd step = random.vector(model.tangent_size(), 0.05);
      model.integrate(at.data(), step.data(), at.data());
      q.push_back(add_configuration(graph, robot, 2 * i, i, at));
      const auto w = graph.add_vertex(2 * i + 1, VertexWrenches(graph.parameters(), numbers));
      graph.add_edge(EdgePlanTracking(at, Eigen::VectorXd::Ones(model.tangent_size())), q.back());
      graph.add_edge(EdgeBalance(1.0, 10.0), q.back(), w);
      graph.add_edge(EdgeTorqueLimits(model, 0.2, 1.0), q.back(), w);
      graph.add_edge(EdgeContactWrench(*graph.vertex(w).contacts, 1.0), w);
      graph.add_edge(EdgeWrenchNorm(graph.vertex(w), 1e-4), w);
      if (i > 0) {
        graph.add_edge(EdgeVelocityTracking(Eigen::VectorXd::Zero(model.tangent_size()),
                                            Eigen::VectorXd::Ones(model.tangent_size())),
                       q[i - 1], q[i]);
      }
    }
    if (eliminate) {
      EXPECT_EQ(mark_wrenches_for_elimination(graph), 3);
      Problem problem;
      problem.compile(graph);
      EXPECT_EQ(problem.pattern().kept, 3) << "one block for each configuration is left";
    }
    OptimiserOptions options;
    options.max_iterations = 2000;
    // Wrenches turn with the links: newtons and radians are coupled.
    options.scale_by_diagonal = true;
    options.initial_lambda = 1e-4;
    options.refused_lambda = 1e-2;
    options.gain = 1e-13;
    const OptimiserResult outcome = optimise(graph, options, *make_linear_solver(solver));
    EXPECT_TRUE(outcome.converged) << solver << ": " << outcome.reason_text();
    EXPECT_LT(outcome.final.chi2, 0.1 * outcome.initial.chi2);
    result.resize(model.configuration_size() + 18, 3);
    for (int i = 0; i < 3; ++i) {
      result.col(i) << graph.vertices_of<VertexConfiguration>()[i].state,
          graph.vertices_of<VertexWrenches>()[i].state;
    }
  };
  Eigen::MatrixXd full, reduced, automatic;
  solve("dense", false, full);
  solve("schur", true, reduced);
  solve("auto", true, automatic);
  EXPECT_LT((full - reduced).cwiseAbs().maxCoeff(), 1e-6 * full.cwiseAbs().maxCoeff());
  EXPECT_LT((full - automatic).cwiseAbs().maxCoeff(), 1e-6 * full.cwiseAbs().maxCoeff());
}

/// The friction of the publication: pyramids of four sides around the cone, centres of pressure in
/// a square, no yaw row, and no moment of the feet about the world's z. Hands are points.
Contact published(const ComanContact& at, double hand_mu, const RobotState& state) {
  Contact contact;
  EndEffector& end = contact.effector;
  end.link = at.frame;
  const bool foot = at.frame.ends_with("sole");
  const Eigen::Matrix3d link_from_world =
      state.world_from_link(state.robot().link_index(at.frame)).linear().transpose();
  const bool floor = at.normal.z() > 0.5;
  contact.normal = at.normal;
  contact.forward = floor ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ();
  end.normal = link_from_world * contact.normal;
  end.forward = link_from_world * *contact.forward;
  end.kind = foot ? ContactKind::kSurface : ContactKind::kPoint;
  end.half_x_m = end.half_y_m = 0.08;
  end.friction = foot ? 0.81 / std::sqrt(2.0) : hand_mu;
  end.max_force_N = 1000.0;
  return contact;
}

class PublishedPosture : public testing::TestWithParam<std::string> {};

TEST_P(PublishedPosture, HasThePublishedWrenchesOfLeastNorm) {
  const RobotCase robot = robot_case("ComanPlus");
  const std::vector<ComanPosture> all = coman_postures();
  const ComanPosture& posture = *std::find_if(
      all.begin(), all.end(), [](const ComanPosture& p) { return p.name == GetParam(); });
  RobotState state(robot.model());
  state.update(posture.configuration().data());

  Graph graph = graph_of(robot);
  std::vector<Contact> contacts;
  for (const ComanContact& at : posture.contacts) {
    contacts.push_back(published(at, posture.name[0] == 'A' ? 0.5 : 0.8, state));
  }
  const std::vector<FrictionModel> cones(contacts.size(), {FrictionCone::kOuter, 4});
  const std::vector<int> numbers = add_contacts(graph, robot, contacts, cones);
  const auto q = add_configuration(graph, robot, 0, 0.0, posture.configuration());
  graph.set_fixed(q, true);
  const auto w = graph.add_vertex(1, VertexWrenches(graph.parameters(), numbers));
  EdgeContactWrench limits(*graph.vertex(w).contacts, 1e6);
  EdgeWrenchNorm norm(graph.vertex(w), 1.0);
  for (int i = 0, row = 0, component = 0; i < 4; ++i) {
    const ContactParameter& contact = *(*graph.vertex(w).contacts)[i];
    if (contact.kind() == ContactKind::kSurface) {
      limits.weights.segment(row + contact.cone->rows() - 8, 8).setZero();
      const bool floor = posture.contacts[i].normal.z() > 0.5;
      norm.weights[component + (floor ? 5 : 3)] = 1e10;
    }
    row += contact.cone->rows();
    component += static_cast<int>(contact.cone->components().size());
  }
  graph.add_edge(EdgeBalance(1e8, 1e8), q, w);
  graph.add_edge(limits, w);
  graph.add_edge(norm, w);
  OptimiserOptions options;
  options.max_iterations = 500;
  options.gain = 1e-15;
  const OptimiserResult outcome = optimise(graph, options, *make_linear_solver("dense"));
  EXPECT_TRUE(outcome.converged) << outcome.reason_text();
  Evaluated evaluated(graph);
  EXPECT_LT(evaluated.error(0, 0).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT((limits.weights.array() > 0.0).select(evaluated.error(0, 1), 0.0).maxCoeff(), 1e-2);

  const double* component = graph.vertex(w).state.data();
  for (std::size_t i = 0; i < posture.contacts.size(); ++i) {
    const ComanContact& expected = posture.contacts[i];
    const ContactParameter& contact = *(*graph.vertex(w).contacts)[i];
    Eigen::Matrix3d axes = contact.axes;
    if (!contact.axes_in_world) axes = state.world_from_link(contact.link).linear() * axes;
    const Eigen::Vector3d force = axes * Eigen::Map<const Eigen::Vector3d>(component);
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    if (contact.kind() == ContactKind::kSurface) {
      moment = axes * Eigen::Map<const Eigen::Vector3d>(component + 3);
    }
    component += contact.cone->components().size();
    EXPECT_LT((force - expected.force).norm(), 0.03 * expected.force.norm())
        << expected.frame << ": " << force.transpose() << ", published "
        << expected.force.transpose();
    EXPECT_LE((moment - expected.moment).norm(), 0.03 * expected.moment.norm())
        << expected.frame << ": " << moment.transpose() << ", published "
        << expected.moment.transpose();
    RecordProperty(expected.frame + "_force",
                   std::to_string((force - expected.force).norm() / expected.force.norm()));
  }
}

INSTANTIATE_TEST_SUITE_P(ComanPlus, PublishedPosture, testing::Values("A1", "A2", "A3", "B1", "C2"),
                         [](const testing::TestParamInfo<std::string>& info) {
                           return info.param;
                         });

}  // namespace
}  // namespace locograph::test::balance
