#include <locograph/common/ranges.h>
#include <locograph/plugins/configuration/limit_kind.h>
#include <locograph/plugins/surface_distance/edge_surface_distance.h>

#include <algorithm>

namespace locograph {

template class TypedEdgePool<EdgeSurfaceDistance>;

namespace {

/// Links that touch a surface are in it however far below; so far it is looked for.
constexpr double kBelowSurface_m = 0.3;
/// Of what is near what it touches, above it: rows that hold to their tolerance keep it out.
constexpr double kOffSurface_m = 2e-4, kTouchingTolerance_m = 1e-4;

/// Of two neighbouring stances.
struct Closed {
  std::vector<Contact> all, held;
};

Closed closed_contacts(const Stance& before, const Stance& after) {
  const bool grows = after.contacts.size() > before.contacts.size();
  const std::vector<Contact>& larger = (grows ? after : before).contacts;
  Closed closed{larger, {}};
  for (const Contact& contact : (grows ? before : after).contacts) {
    const bool common = std::ranges::find(larger, contact.name(), &Contact::name) != larger.end();
    (common ? closed.held : closed.all).push_back(contact);
  }
  return closed;
}

}  // namespace

void ParameterNumbers::read(FieldReader& in) {
  const int count = in.integer();
  if (count < 0 || count > ranges::kContacts) {
    in.fail("number of contacts " + std::to_string(count),
            "0 to " + std::to_string(ranges::kContacts));
  }
  for (int i = 0; i < count; ++i) all.push_back(in.integer());
}

void ParameterNumbers::write(FieldWriter& out) const {
  out.integer(static_cast<long>(all.size()));
  for (const int number : all) out.integer(number);
}

EdgeSurfaceDistance::EdgeSurfaceDistance(const RobotParameter& robot, int of_places, int of_before,
                                         int of_after, double margin, double weight,
                                         std::vector<int> of_near)
    : places_number(of_places),
      before_number(of_before),
      after_number(of_after),
      margin_m(margin),
      near_numbers{std::move(of_near)} {
  weights.setConstant(static_cast<Eigen::Index>(robot.bounds.size()), weight);
}

void EdgeSurfaceDistance::bind(const Parameters& parameters) {
  require_margin(kTag, margin_m);
  const auto places_now = parameters.get<PlacesParameter>(places_number);
  const auto before_now = parameters.get<StanceParameter>(before_number);
  const auto after_now = parameters.get<StanceParameter>(after_number);
  const std::shared_ptr<const RobotParameter>& robot = places_now->places->robot();
  require_same_robot(kTag, before_now->robot, robot);
  require_same_robot(kTag, after_now->robot, robot);
  require_rows(kTag, dimension(), static_cast<long>(robot->bounds.size()));
  ContactList near_now;
  for (const int number : near_numbers.all) {
    near_now.push_back(parameters.get<ContactParameter>(number));
    require_same_robot(kTag, near_now.back()->robot, robot);
  }
  if (relations && places == places_now && before == before_now && after == after_now &&
      near == near_now) {
    return;
  }
  places = places_now;
  before = before_now;
  after = after_now;
  near = near_now;
  const Closed closed = closed_contacts(before->stance, after->stance);
  if (closed.held.empty()) {
    throw locograph::Error(std::string(kTag) + " between two stances without a common contact",
                           "stances that follow each other in a plan");
  }
  std::vector<Contact> not_closed;
  for (const auto& one : near) {
    const std::string& name = one->contact.name();
    if (std::ranges::find(closed.all, name, &Contact::name) != closed.all.end()) {
      throw locograph::Error(std::string(kTag) + " with '" + name + "' both closed and near",
                             "one of them");
    }
    not_closed.push_back(one->contact);
  }
  PlaceRelations made(places->places);
  made.set_contacts(closed.all, closed.held, not_closed, kOffSurface_m);
  made.relate_all();
  relations = std::make_shared<const PlaceRelations>(std::move(made));
}

std::optional<PlaceRow> EdgeSurfaceDistance::worst_row(const ConfigurationState& q,
                                                       std::size_t bound) const {
  const double reach = q.robot->bounds[bound].radius + std::max(margin_m, kBelowSurface_m);
  const PlaceBands bands{.margin_m = margin_m};
  std::optional<PlaceRow> worst;
  relations->places().tree().each_touching(
      box_around(q.bound_centre(bound), reach), [&](int place) {
        const std::optional<PlaceRow> row =
            place_row(q, *relations, place, static_cast<std::size_t>(place), bound, bands);
        if (row && row->value < (worst ? worst->value : 0.0)) worst = row;
      });
  return worst;
}

void EdgeSurfaceDistance::error(const ConfigurationState& q, Eigen::Ref<Eigen::VectorXd> e) const {
  require_same_robot(kTag, q.robot, places->places->robot());
  for (Eigen::Index b = 0; b < e.size(); ++b) {
    e[b] = 0.0;
    if (weights[b] == 0.0) continue;
    const std::optional<PlaceRow> worst = worst_row(q, static_cast<std::size_t>(b));
    if (worst) e[b] = -worst->value;
  }
}

void EdgeSurfaceDistance::jacobians(const ConfigurationState& q,
                                    JacobianRef<EdgeSurfaceDistance, 0> j) const {
  for (Eigen::Index b = 0; b < j.rows(); ++b) {
    if (weights[b] == 0.0) continue;
    const std::size_t bound = static_cast<std::size_t>(b);
    const std::optional<PlaceRow> worst = worst_row(q, bound);
    if (!worst) continue;
    q.kinematics.add_point_gradient(q.robot->bounds[bound].link, worst->point, worst->gradient,
                                    -1.0, j.row(b).data());
  }
}

double EdgeSurfaceDistance::row_tolerance(int row) const {
  const double of_margin = margin_tolerance(margin_m);
  return relations->touches(static_cast<std::size_t>(row))
             ? std::min(kTouchingTolerance_m, of_margin)
             : of_margin;
}

RowLabel EdgeSurfaceDistance::row_label(int row) const {
  const RobotParameter& robot = *places->places->robot();
  const int link = robot.bounds[static_cast<std::size_t>(row)].link;
  return {robot.robot->links()[static_cast<std::size_t>(link)].name + " near a surface, bar or box",
          "m"};
}

}  // namespace locograph
