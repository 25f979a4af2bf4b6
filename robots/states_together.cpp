#include <locograph/robots/kinematic_tree.h>
#include <locograph/robots/states_together.h>

#include <algorithm>
#include <vector>

namespace locograph {
namespace {

TreeView view_of(const Robot& robot) {
  const KinematicTree& tree = robot.tree();
  const Eigen::Vector4d& root = tree.bodies[0].moment;
  return {tree.flat_axes.data(),
          static_cast<int>(tree.flat_axes.size()),
          tree.flat_links.data(),
          static_cast<int>(tree.flat_links.size()),
          static_cast<int>(robot.links().size()),
          {root[0], root[1], root[2]},
          root[3],
          tree.bodies[0].subtree_mass,
          robot.floating_base()};
}

}  // namespace

void update_together(std::span<const StateUpdate> updates, std::span<const LinkPoint> first,
                     std::span<const LinkPoint> second, const TreeKernels& kernels) {
  if (updates.empty()) return;
  const TreeView tree = view_of(updates.front().state->robot());
  const PointsView points[2] = {{first.data(), static_cast<int>(first.size())},
                                {second.data(), static_cast<int>(second.size())}};
  // Aligned as vector registers like it.
  struct alignas(64) Line {
    double numbers[8];
  };
  thread_local std::vector<Line> work;
  const auto lines = static_cast<std::size_t>(kernels.work(tree, points)) / 8 + 1;
  work.resize(std::max(work.size(), lines));
  constexpr std::size_t kMost = 32;
  std::array<TreeState, kMost> states;
  for (std::size_t done = 0; done < updates.size(); done += kMost) {
    const std::size_t count = std::min(kMost, updates.size() - done);
    for (std::size_t i = 0; i < count; ++i) {
      const StateUpdate& update = updates[done + i];
      RobotState& state = *update.state;
      states[i] = {update.q,
                   state.world_from_link_.front().matrix().data(),
                   state.joint_axis_.empty() ? nullptr : state.joint_axis_.front().data(),
                   state.joint_origin_.empty() ? nullptr : state.joint_origin_.front().data(),
                   state.subtree_moment_.front().data(),
                   {update.points[0], update.points[1]}};
    }
    kernels.update(tree, points, static_cast<int>(count), states.data(), work.data()->numbers);
  }
}

}  // namespace locograph
