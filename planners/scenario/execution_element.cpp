#include <locograph/planners/scenario/execution_element.h>

#include <string>

namespace locograph {
namespace {

double read_within(const XmlFile& xml, const XmlFile::Element& execution, const char* name,
                   double otherwise, const std::string& expected, auto&& is_good) {
  if (execution.Attribute(name) == nullptr) return otherwise;
  const double value = xml.number(execution, name);
  if (is_good(value)) return value;
  throw xml.error(execution, std::string(name) + "=\"" + xml.attribute(execution, name) + "\"",
                  expected);
}

}  // namespace

ExecutionMargin read_execution_margin(const XmlFile& xml, const XmlFile::Element& execution) {
  xml.allow(execution,
            {"friction", "area", "torque", "joint", "self_distance", "least_force", "dwell"}, {});
  ExecutionMargin margin;
  const auto read_share = [&](const char* name, double& share) {
    share = read_within(xml, execution, name, share, "a share that is used, above 0, at most 1",
                        [](double value) { return value > 0.0 && value <= 1.0; });
  };
  read_share("friction", margin.friction);
  read_share("area", margin.area);
  read_share("torque", margin.torque);
  const auto up_to = [](double most) {
    return [most](double value) { return value >= 0.0 && value <= most; };
  };
  margin.joint_rad = read_within(xml, execution, "joint", margin.joint_rad, "0 to 1 rad",
                                 up_to(ExecutionMargin::kMostJoint_rad));
  margin.self_distance_m = read_within(xml, execution, "self_distance", margin.self_distance_m,
                                       "0 to 0.2 m", up_to(ExecutionMargin::kMostSelfDistance_m));
  margin.least_force = read_within(xml, execution, "least_force", margin.least_force,
                                   "a part of the robot's weight, 0 or more, less than 1",
                                   [](double value) { return value >= 0.0 && value < 1.0; });
  margin.dwell_s = read_within(xml, execution, "dwell", margin.dwell_s, "0 to 60 s",
                               up_to(ExecutionMargin::kMostDwell_s));
  return margin;
}

}  // namespace locograph
