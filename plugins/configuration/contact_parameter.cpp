#include <locograph/common/ranges.h>
#include <locograph/plugins/configuration/contact_parameter.h>
#include <locograph/plugins/configuration/plan_parameters.h>
#include <locograph/robots/contact_kinds.h>

#include <cmath>
#include <cstdio>

namespace locograph {
namespace {

std::string brief(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

/// A number up to `most`; what is positive, the contact itself demands.
double read_up_to(FieldReader& in, double most, const std::string& what) {
  const std::string token(in.peek());
  const double value = in.number();
  if (std::abs(value) <= most) return value;
  in.fail(what + " " + token, "at most " + brief(most));
}

/// A place [m] or a direction.
Eigen::Vector3d read_vector(FieldReader& in) {
  Eigen::Vector3d v;
  for (double& number : v) number = read_up_to(in, ranges::kCoordinate_m, "the coordinate");
  return v;
}

/// The kind with its sizes and limits.
void read_kind(FieldReader& in, EndEffector& effector) {
  const std::string word = in.word();
  const std::optional<ContactKind> kind = contact_kind_of(word);
  if (!kind) in.fail("contact kind '" + word + "'", contact_kind_names("'"));
  effector.kind = *kind;
  for (const EffectorField& field : contact_kind_entry(*kind).fields) {
    effector.*field.value = read_up_to(in, field.most, std::string("the ") + field.quantity);
  }
}

void write_kind(FieldWriter& out, const EndEffector& effector) {
  const ContactKindEntry& kind = contact_kind_entry(effector.kind);
  out.word(kind.name);
  for (const EffectorField& field : kind.fields) out.number(effector.*field.value);
}

void read_place(FieldReader& in, Contact& contact) {
  if (const std::string at = in.word(); at != "at") {
    in.fail("'" + at + "'", "'at' and the contact's place in the world");
  }
  contact.position = read_vector(in);
  contact.normal = read_vector(in);
  if (in.peek() == "free") {
    in.word();
  } else {
    contact.forward = read_vector(in);
  }
}

}  // namespace

ContactParameter::ContactParameter(std::shared_ptr<const RobotParameter> parameter, int number,
                                   Contact placed, const FrictionModel& model)
    : robot_number(number),
      contact(std::move(placed)),
      friction(model),
      robot(std::move(parameter)) {
  const EndEffector& effector = contact.effector;
  closure = ContactClosure(*robot->robot, contact);
  link = robot->robot->link_index(effector.link);
  const ContactKindEntry& entry = contact_kind_entry(kind());
  axes_in_world = !entry.axes_on_link;
  axes = axes_in_world ? locograph::axes_in_world(contact) : axes_in_link(effector);
  if (axes_in_world) touching_offset = -effector.radius_m * axes.col(2);
  if (contact.bar && is_ball(effector)) about_bar.emplace(contact);
  cone = entry.wrench_cone(contact, friction);
}

void ContactParameter::read(FieldReader& in) {
  const int number = in.integer();
  const auto of = in.parameters()->get<RobotParameter>(number);
  Contact read;
  read.effector.name = in.word();
  // Where a link is named now, a plan of version 1 had the first number of its point.
  if (std::string_view("+-.0123456789").find(in.peek().substr(0, 1)) != std::string_view::npos) {
    refuse_older_plan(in, tag());
  }
  read.effector.link = in.word();
  read_kind(in, read.effector);
  read.effector.point = read_vector(in);
  read.effector.normal = read_vector(in);
  read.effector.forward = read_vector(in);
  read_place(in, read);
  FrictionModel model;
  while (!in.at_end()) {
    const std::string word = in.word();
    if (word == "unloaded" && read.bears_load) {
      read.bears_load = false;
    } else if (word == "locked" && !read.locked) {
      read.locked = true;
    } else if ((word == "inner" || word == "outer") && model.cone == FrictionCone::kCircle) {
      model.cone = word == "inner" ? FrictionCone::kInner : FrictionCone::kOuter;
      model.facets = in.integer();
    } else if (word == "bar" && !read.bar) {
      const double radius_m = read_up_to(in, ranges::kCoordinate_m, "the radius");
      read.bar = RoundBar{read_vector(in), radius_m};
    } else {
      in.fail("'" + word + "'",
              "'unloaded', 'locked', 'inner', 'outer', 'bar' or the end of the line");
    }
  }
  *this = ContactParameter(of, number, std::move(read), model);
}

void ContactParameter::write(FieldWriter& out) const {
  out.integer(robot_number);
  out.word(contact.effector.name);
  out.word(contact.effector.link);
  write_kind(out, contact.effector);
  write_field(out, contact.effector.point);
  write_field(out, contact.effector.normal);
  write_field(out, contact.effector.forward);
  out.word("at");
  write_field(out, contact.position);
  write_field(out, contact.normal);
  if (contact.forward) {
    write_field(out, *contact.forward);
  } else {
    out.word("free");
  }
  if (!contact.bears_load) out.word("unloaded");
  if (contact.locked) out.word("locked");
  if (contact.bar) {
    out.word("bar");
    out.number(contact.bar->radius_m);
    write_field(out, contact.bar->axis);
  }
  if (friction.cone == FrictionCone::kCircle) return;
  out.word(friction.cone == FrictionCone::kInner ? "inner" : "outer");
  out.integer(friction.facets);
}

}  // namespace locograph
