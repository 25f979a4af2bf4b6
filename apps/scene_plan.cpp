#include <locograph/apps/about_file.h>
#include <locograph/apps/check_json.h>
#include <locograph/apps/packed.h>
#include <locograph/apps/scene.h>
#include <locograph/check/judged_stance.h>
#include <locograph/check/motion_curve.h>
#include <locograph/planners/plan/record.h>
#include <locograph/plugins/static_balance/static_rows.h>
#include <locograph/plugins/static_balance/vertex_wrenches.h>
#include <locograph/robots/contact_kinds.h>
#include <locograph/robots/robot_state.h>
#include <locograph/robots/rolling_ball.h>
#include <locograph/world/convex_hull.h>

#include <algorithm>
#include <map>
#include <utility>

namespace locograph {
namespace {

const VertexConfiguration& configuration(const PlanFile& file, int slot) {
  return file.graph.vertex(VertexId<VertexConfiguration>{slot});
}

void append(const Eigen::VectorXd& q, std::vector<float>& numbers) {
  for (const double value : q) numbers.push_back(static_cast<float>(value));
}

/// Where in the state of a VERTEX_WRENCHES the wrench of a contact begins.
struct WrenchPlace {
  const VertexWrenches* vertex;
  int first;
};
/// Of a configuration, by the number of the contact.
std::map<int, WrenchPlace> wrench_places(const PlanFile& file, std::size_t i) {
  std::map<int, WrenchPlace> places;
  for (const int slot : file.plan.index.wrenches[i]) {
    const VertexWrenches& wrenches = file.graph.vertex(VertexId<VertexWrenches>{slot});
    int first = 0;
    for (std::size_t c = 0; c < wrenches.contact_numbers.size(); ++c) {
      places.emplace(wrenches.contact_numbers[c], WrenchPlace{&wrenches, first});
      first += static_cast<int>((*wrenches.contacts)[c]->cone->components().size());
    }
  }
  return places;
}

/// On the robot, in the world frame, at the touching point.
void add_wrench(const ContactParameter& contact, const RobotState& state, const WrenchPlace& place,
                Json& json) {
  const AppliedWrench applied(state, contact, place.vertex->state.data() + place.first);
  json["force"] = vector_json(applied.force);
  // What turns on its contact bears no moment there.
  if (!contact.axes_in_world) json["moment"] = vector_json(applied.moment);
}

/// What the stances of a plan lie on, by whose word it is judged.
class TouchedWorld {
 public:
  TouchedWorld(const Robot& robot, const Judging* judging) : robot_(robot) {
    if (judging == nullptr) return;
    world_ = judging->world->world();
    known_ = judging->options.known;
  }

  /// Of each contact, where the robot is in this state.
  std::vector<Support> supports(const StanceParameter& stance, const RobotState& state) {
    const JudgedStance& judged =
        judged_.try_emplace(&stance, robot_, world_, stance.stance, known_).first->second;
    std::vector<Eigen::Isometry3d> poses;
    for (int link = 0; link < static_cast<int>(robot_.links().size()); ++link) {
      poses.push_back(state.world_from_link(link));
    }
    std::vector<Support> supports;
    for (const JudgedContact& contact : judged.contacts) {
      supports.push_back(support_of(contact, world_, poses));
    }
    return supports;
  }

 private:
  const Robot& robot_;
  World world_;
  std::vector<EndEffector> known_;
  std::map<const StanceParameter*, JudgedStance> judged_;
};

/// In the world; all of the sole where it is not known what it lies on.
Json area_json(const Support& support, const ContactParameter& parameter, const RobotState& state) {
  const EndEffector& sole = parameter.contact.effector;
  std::vector<PlanePoint> corners;
  for (const Eigen::Vector2d& corner : support.area) corners.push_back({corner.x(), corner.y()});
  if (!support.known) {
    for (const auto& [x, y] :
         {std::pair(1, 1), std::pair(-1, 1), std::pair(-1, -1), std::pair(1, -1)})
      corners.push_back({x * sole.half_x_m, y * sole.half_y_m});
  }
  const Eigen::Isometry3d& pose = state.world_from_link(parameter.link);
  const Eigen::Matrix3d axes = pose.linear() * axes_in_link(sole);
  Json area = Json::array();
  for (const PlanePoint& corner : convex_hull(std::move(corners))) {
    const Eigen::Vector2d along(corner.x, corner.y);
    area.push_back(vector_json(pose * sole.point + axes.leftCols<2>() * along));
  }
  return area;
}

Json contact_json(const ContactParameter& parameter, const RobotState& state,
                  const Support& support) {
  const Contact contact = rolled_to(state, parameter.contact);
  const ContactKindEntry& kind = contact_kind_entry(parameter.kind());
  Json json = {{"name", contact.name()},
               {"link", parameter.link},
               {"kind", kind.name},
               {"position", vector_json(kind.touching_point(state, contact))},
               {"normal", vector_json(contact.normal.stableNormalized())}};
  if (contact.effector.radius_m > 0.0) json["radius"] = contact.effector.radius_m;
  if (support.friction > 0.0) json["friction"] = support.friction;
  if (kind.has_area()) json["area"] = area_json(support, parameter, state);
  if (contact.locked) json["locked"] = true;
  return json;
}

/// Steps in a row with one stance, as indices of configurations.
Json stances_json(const Plan& plan) {
  Json all = Json::array();
  const int count = static_cast<int>(plan.slots.size());
  for (int from = 0, to = 0; from < count; from = to) {
    const StanceParameter* stance = plan.stance_from[static_cast<std::size_t>(from)].get();
    for (to = from; to < count; ++to) {
      if (plan.stance_from[static_cast<std::size_t>(to)].get() != stance) break;
    }
    if (stance == nullptr) continue;
    Json names = Json::array();
    for (const Contact& contact : stance->stance.contacts) names.push_back(contact.name());
    all.push_back(
        {{"from", from}, {"to", std::min(to, count - 1)}, {"contacts", std::move(names)}});
  }
  return all;
}

Json series_json(const char* name, const char* unit, const std::vector<double>& values) {
  const std::vector<float> numbers(values.begin(), values.end());
  return {{"name", name}, {"unit", unit}, {"values", packed_floats(numbers)}};
}

/// What a record says beside a plan: torques, and how far the robot is off.
void add_record(const PlanFile& file, Json& plan) {
  const Robot& robot = *file.plan.robot->robot;
  const Record record = about_file(file.name, [&] { return record_of(file.graph, file.plan); });
  const TrackingErrors errors = tracking_errors(robot, record);
  std::vector<float> torques;
  std::vector<double> largest_torque;
  for (const Eigen::VectorXd& moment : record.torques) {
    append(moment, torques);
    double largest = 0.0;
    for (int j = 0; j < robot.active_joint_count(); ++j) {
      const double effort = robot.active_joint(j).max_effort;
      if (effort > 0.0) largest = std::max(largest, std::abs(moment[j]) / effort);
    }
    largest_torque.push_back(largest);
  }
  plan["recorded"] = true;
  plan["torques"] = packed_floats(torques);
  plan["series"] = Json::array();
  if (robot.floating_base()) {
    plan["series"].push_back(series_json("base off", "m", errors.base_m));
  }
  plan["series"].push_back(series_json("torque / effort", "", largest_torque));
  plan["series"].back()["limit"] = 1.0;
}

}  // namespace

void add_plan_scene(const PlanFile& file, const Judging* judging, const SceneOptions& options,
                    Json& scene) {
  const Robot& robot = *file.plan.robot->robot;
  const std::vector<Eigen::VectorXd> planned = tracked_configurations(file.graph, file.plan);
  TouchedWorld touched(robot, judging);
  RobotState state(robot);
  std::vector<float> configurations, reference;
  Json times = Json::array(), ids = Json::array(), contacts = Json::array();
  for (std::size_t i = 0; i < file.plan.slots.size(); ++i) {
    const int slot = file.plan.slots[i];
    const VertexConfiguration& vertex = configuration(file, slot);
    times.push_back(rounded(vertex.time_s));
    ids.push_back(file.graph.vertex_record(slot).id);
    append(vertex.state, configurations);
    append(planned[i].size() == 0 ? Eigen::VectorXd(vertex.state) : planned[i], reference);
    state.update(vertex.state.data());
    Json here = Json::array();
    if (const StanceParameter* stance = file.plan.stance_from[i].get()) {
      const std::vector<Support> supports = touched.supports(*stance, state);
      const std::map<int, WrenchPlace> wrenches = wrench_places(file, i);
      for (std::size_t k = 0; k < stance->contacts.size(); ++k) {
        here.push_back(contact_json(*stance->contacts[k], state, supports[k]));
        const auto place = wrenches.find(stance->contact_numbers[k]);
        if (place != wrenches.end()) {
          add_wrench(*stance->contacts[k], state, place->second, here.back());
        }
      }
    }
    contacts.push_back(std::move(here));
  }
  const int count = static_cast<int>(file.plan.slots.size());
  Json plan = {{"times", std::move(times)},
               {"configurations", packed_floats(configurations)},
               {"configuration_size", robot.configuration_size()},
               {"ids", std::move(ids)}};
  if (file.plan.stances_only) {
    plan["stances_only"] = true;
  } else if (count > 1) {
    const Motion motion = motion_of(file.graph, file.plan);
    const MotionCurve curve(robot, motion);
    std::vector<float> slopes;
    for (int i = 0; i < count; ++i) append(curve.slope(i), slopes);
    plan["slopes"] = packed_floats(slopes);
  }
  const auto is_tracked = [](const Eigen::VectorXd& q) { return q.size() > 0; };
  if (std::ranges::any_of(planned, is_tracked)) plan["reference"] = packed_floats(reference);
  if (file.plan.recorded) add_record(file, plan);
  if (options.executed >= 0) {
    if (options.executed >= count) {
      throw Error(file.name, 0, "no configuration " + std::to_string(options.executed),
                  "0 to " + std::to_string(count - 1));
    }
    plan["executed"] = options.executed;
    plan["window"] = std::min(options.window, count - 1 - options.executed);
  }
  Json stances = stances_json(file.plan);
  if (!stances.empty()) {
    plan["contacts"] = std::move(contacts);
    scene["stances"] = std::move(stances);
  }
  scene["plan"] = std::move(plan);
}

Json check_scene(const PlanFile& file, const CheckReport& report) {
  Json json = check_json(report, [&](int vertex) {
    const int slot = file.plan.slots.at(static_cast<std::size_t>(vertex));
    return file.graph.vertex_record(slot).id;
  });
  for (std::size_t i = 0; i < report.violations.size(); ++i) {
    const Violation& v = report.violations[i];
    json["violations"][i]["index"] = v.at_vertex;
    json["violations"][i]["at_point"] = vector_json(v.at_point);
  }
  return json;
}

}  // namespace locograph
