#include <locograph/plugins/configuration/surface_axes.h>
#include <locograph/plugins/static_balance/contact_parameter.h>

#include <array>
#include <cmath>

namespace locograph {
namespace {

constexpr std::array<const char*, 3> kKinds = {"surface", "point", "rung"};
constexpr int kMostFacets = 64;

void require_positive(const std::string& contact, const char* what, double value) {
  if (value > 0.0) return;
  throw Error(contact + " has " + what + " " + std::to_string(value),
              std::string(what) + " above zero");
}

Eigen::Vector3d read_vector(FieldReader& in) {
  Eigen::Vector3d v;
  read_field(in, v);
  return v;
}

}  // namespace

ContactParameter::ContactParameter(std::shared_ptr<const RobotParameter> parameter, int number,
                                   ContactDescription description)
    : robot_number(number), given(std::move(description)), robot(std::move(parameter)) {
  link = robot->robot->link_index(given.link);
  const std::string contact = "contact of " + given.link;
  axes = surface_axes(contact, given.normal, given.forward);

  require_positive(contact, "a force limit of", given.max_force_N);
  if (given.kind == WrenchKind::kRung) {
    if (!(given.max_moment_Nm >= 0.0)) {
      throw Error(contact + " has a moment limit of " + std::to_string(given.max_moment_Nm),
                  "zero or more");
    }
    if (given.cone != FrictionCone::kCircle) {
      throw Error(contact + " is a rung with a friction cone", "none: it is held by a grasp");
    }
    return;
  }
  require_positive(contact, "a friction coefficient of", given.mu);
  if (given.kind == WrenchKind::kSurface) {
    require_positive(contact, "a half size x of", given.half_x_m);
    require_positive(contact, "a half size y of", given.half_y_m);
  }
  const bool outer = given.cone == FrictionCone::kOuter;
  yaw_mu = outer ? given.mu : given.mu / std::sqrt(2.0);
  facet_mu = given.mu;
  if (given.cone == FrictionCone::kCircle) return;
  if (given.facets < 3 || given.facets > kMostFacets) {
    throw Error(contact + " has a friction pyramid of " + std::to_string(given.facets) + " sides",
                "3 to " + std::to_string(kMostFacets));
  }
  if (!outer) facet_mu *= std::cos(EIGEN_PI / given.facets);
  const auto exact = [](double value) { return std::abs(value) < 1e-15 ? 0.0 : value; };
  for (int i = 0; i < given.facets; ++i) {
    const double angle = 2.0 * EIGEN_PI * i / given.facets;
    facets.emplace_back(exact(std::cos(angle)), exact(std::sin(angle)));
  }
}

std::span<const int> ContactParameter::components() const {
  static constexpr int kSurface[] = {0, 1, 2, 3, 4, 5}, kRung[] = {0, 1, 2, 3, 5};
  if (given.kind == WrenchKind::kRung) return kRung;
  return std::span<const int>(kSurface).first(given.kind == WrenchKind::kPoint ? 3 : 6);
}

int ContactParameter::limit_rows() const {
  if (given.kind == WrenchKind::kRung) return 5;
  const int force = 2 + (given.cone == FrictionCone::kCircle ? 1 : given.facets);
  return given.kind == WrenchKind::kPoint ? force : force + 12;
}

void ContactParameter::read(FieldReader& in) {
  const int number = in.integer();
  const auto of = in.parameters()->get<RobotParameter>(number);
  ContactDescription read;
  read.link = in.word();
  read.point = read_vector(in);
  const std::string where = in.word();
  if (where != "link" && where != "world") {
    in.fail("axes fixed in the '" + where + "'", "'link' or 'world'");
  }
  read.axes_in_world = where == "world";
  read.normal = read_vector(in);
  read.forward = read_vector(in);
  const std::string kind = in.word();
  if (kind == kKinds[0]) {
    read.kind = WrenchKind::kSurface;
    read.half_x_m = in.number();
    read.half_y_m = in.number();
    read.mu = in.number();
    read.max_force_N = in.number();
  } else if (kind == kKinds[1]) {
    read.kind = WrenchKind::kPoint;
    read.mu = in.number();
    read.max_force_N = in.number();
  } else if (kind == kKinds[2]) {
    read.kind = WrenchKind::kRung;
    read.max_force_N = in.number();
    read.max_moment_Nm = in.number();
  } else {
    in.fail("contact kind '" + kind + "'", "'surface', 'point' or 'rung'");
  }
  if (!in.at_end()) {
    const std::string cone = in.word();
    if (cone != "inner" && cone != "outer") {
      in.fail("'" + cone + "'", "'inner', 'outer' or the end of the line");
    }
    read.cone = cone == "inner" ? FrictionCone::kInner : FrictionCone::kOuter;
    read.facets = in.integer();
  }
  *this = ContactParameter(of, number, std::move(read));
}

void ContactParameter::write(FieldWriter& out) const {
  out.integer(robot_number);
  out.word(given.link);
  write_field(out, given.point);
  out.word(given.axes_in_world ? "world" : "link");
  write_field(out, given.normal);
  write_field(out, given.forward);
  out.word(kKinds[static_cast<std::size_t>(given.kind)]);
  if (given.kind == WrenchKind::kSurface) {
    out.number(given.half_x_m);
    out.number(given.half_y_m);
  }
  if (given.kind != WrenchKind::kRung) out.number(given.mu);
  out.number(given.max_force_N);
  if (given.kind == WrenchKind::kRung) out.number(given.max_moment_Nm);
  if (given.cone == FrictionCone::kCircle) return;
  out.word(given.cone == FrictionCone::kInner ? "inner" : "outer");
  out.integer(given.facets);
}

}  // namespace locograph
