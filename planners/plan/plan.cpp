#include <locograph/planners/plan/plan.h>
#include <locograph/plugins/configuration/plan_parameters.h>
#include <locograph/plugins/configuration/segment_parameter.h>
#include <locograph/plugins/plan_tracking/edge_plan_tracking.h>
#include <locograph/plugins/static_balance/vertex_wrenches.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <span>

namespace locograph {
namespace {

const VertexConfiguration& configuration(const Graph& graph, int slot) {
  return graph.vertex(VertexId<VertexConfiguration>{slot});
}

/// The only parameter of its type, null if there is none.
template <class P>
std::shared_ptr<const P> only(const Parameters& parameters) {
  const std::set<int> numbers = parameters.numbers_of<P>();
  auto found = parameters.find<P>();
  if (numbers.size() > 1) {
    throw Error(
        "",
        std::max(parameters.line(*numbers.begin()), parameters.line(*std::next(numbers.begin()))),
        "a second " + std::string(found->tag()) + " in a plan", "one");
  }
  return found;
}

/// Wrenches act at contacts of a stance that the configuration is in: of the step before or after.
/// One that opens there carries nothing.
void require_wrenches_of_stances(const Graph& graph, const Plan& plan) {
  const auto holds = [&](std::size_t step, int contact) {
    return plan.stance_from[step] &&
           std::ranges::count(plan.stance_from[step]->contact_numbers, contact) > 0;
  };
  for (std::size_t i = 0; i < plan.slots.size(); ++i) {
    if (plan.index.wrenches[i].size() > 1) {
      throw Error("", graph.vertex_record(plan.index.wrenches[i][1]).line,
                  "configuration " + std::to_string(graph.vertex_record(plan.slots[i]).id) +
                      " has wrenches twice",
                  "them once");
    }
    for (const int slot : plan.index.wrenches[i]) {
      const VertexWrenches& given = graph.vertex(VertexId<VertexWrenches>{slot});
      Eigen::Index at = 0;
      for (std::size_t c = 0; c < given.contact_numbers.size(); ++c) {
        const int contact = given.contact_numbers[c];
        const auto size =
            static_cast<Eigen::Index>((*given.contacts)[c]->cone->components().size());
        const bool carries = !given.state.segment(at, size).isZero(0.0);
        at += size;
        const bool opens = i > 0 && holds(i - 1, contact);
        if (holds(i, contact) || (opens && !carries)) continue;
        throw Error("", graph.vertex_record(slot).line,
                    "configuration " + std::to_string(graph.vertex_record(plan.slots[i]).id) +
                        " has wrenches at contact " + std::to_string(contact) +
                        (opens ? ", which opens there" : ", which no stance of it has"),
                    opens ? "zeros" : "contacts of its stances");
      }
    }
  }
}

/// What a plan of stances is: at times 0, 1, 2, …, each step with one contact more or less than the
/// one before, and no segments. Anything else is a motion.
bool is_stance_sequence(const Graph& graph, const std::vector<int>& slots) {
  if (graph.parameters().find<SegmentParameter>()) return false;
  std::vector<int> before;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const VertexConfiguration& vertex = configuration(graph, slots[i]);
    if (vertex.time_s != static_cast<double>(i) || vertex.slopes.size() > 0) return false;
    std::vector<int> contacts;
    if (vertex.stance_number != kNoStance) {
      contacts = graph.parameters().get<StanceParameter>(vertex.stance_number)->contact_numbers;
    }
    std::ranges::sort(contacts);
    std::vector<int> changed;
    std::ranges::set_symmetric_difference(before, contacts, std::back_inserter(changed));
    if (i > 0 && changed.size() != 1) return false;
    before = std::move(contacts);
  }
  return true;
}

/// As exactly as hand-written files and those of nanoseconds have times.
constexpr double kSameTime_s = 1e-6;

struct GivenSegment {
  std::shared_ptr<const SegmentParameter> segment;
  int number = 0, line = 0;  ///< of the parameter

  [[noreturn]] void fail(const std::string& what, const std::string& expected) const {
    throw Error("", line, "segment " + std::to_string(segment->segment) + what, expected);
  }
  double end_s() const { return segment->from_s + segment->duration_s; }
};

/// In their order.
std::vector<GivenSegment> given_segments(const Parameters& parameters) {
  std::vector<GivenSegment> given;
  for (const int number : parameters.numbers_of<SegmentParameter>()) {
    given.push_back({parameters.get<SegmentParameter>(number), number, parameters.line(number)});
  }
  std::ranges::stable_sort(given, {}, [](const GivenSegment& g) { return g.segment->segment; });
  return given;
}

std::string time_text(double time_s) { return std::to_string(time_s) + " s"; }

/// The segments that the parameters say, each held against the configurations.
std::vector<PlanSegment> segments_of(const Graph& graph, const Plan& plan) {
  const auto vertex = [&](std::size_t i) -> const VertexConfiguration& {
    return configuration(graph, plan.slots[i]);
  };
  const std::vector<GivenSegment> given = given_segments(graph.parameters());
  std::vector<PlanSegment> segments;
  std::size_t at = 0;
  for (const GivenSegment& one : given) {
    const int expected = static_cast<int>(segments.size());
    if (one.segment->segment < expected) one.fail(" is there twice", "it once");
    if (one.segment->segment > expected) {
      one.fail(" without those before it", "a segment " + std::to_string(expected));
    }
    const double begin_s = vertex(at).time_s;
    if (std::abs(one.segment->from_s - begin_s) > kSameTime_s) {
      one.fail(" begins at " + time_text(one.segment->from_s),
               (expected == 0 ? "the plan's beginning, " : "the end of the segment before, ") +
                   time_text(begin_s));
    }
    const std::size_t first = at;
    for (; at + 1 < plan.slots.size() && vertex(at).time_s < one.end_s() - kSameTime_s; ++at) {
      if (vertex(at).stance_number == one.segment->stance_number) continue;
      one.fail(" is in stance " + std::to_string(one.segment->stance_number),
               "the stance of configuration " +
                   std::to_string(graph.vertex_record(plan.slots[at]).id) + " in it");
    }
    if (std::abs(vertex(at).time_s - one.end_s()) > kSameTime_s) {
      one.fail(" ends at " + time_text(one.end_s()) + ", where no configuration is",
               "the time of one, as " + time_text(vertex(at).time_s));
    }
    if (at == first && plan.slots.size() > 1) {
      one.fail(" takes no time", "configurations from its beginning to its end");
    }
    segments.push_back({static_cast<int>(first), static_cast<int>(at), one.segment->duration_s,
                        one.segment->planner});
  }
  if (!given.empty() && at + 1 < plan.slots.size()) {
    given.back().fail(
        " is the last one and ends at " + time_text(given.back().end_s()),
        "segments until the plan ends, " + time_text(vertex(plan.slots.size() - 1).time_s));
  }
  return segments;
}

/// Ends the segments where the configurations end.
void cut_segments(Graph& graph) {
  double end_s = -std::numeric_limits<double>::infinity();
  for (int slot = 0; slot < graph.vertex_slots(); ++slot) {
    if (!graph.vertex_alive(slot) || !vertex_is<VertexConfiguration>(graph, slot)) continue;
    end_s = std::max(end_s, configuration(graph, slot).time_s);
  }
  for (const GivenSegment& one : given_segments(graph.parameters())) {
    if (one.end_s() <= end_s + kSameTime_s) continue;
    if (one.segment->from_s >= end_s - kSameTime_s) {
      graph.parameters().remove(one.number);
      continue;
    }
    const auto shorter = std::make_shared<SegmentParameter>(*one.segment);
    shorter->duration_s = end_s - one.segment->from_s;
    graph.parameters().replace(one.number, shorter);
  }
}

/// At each contact of the stance that a configuration is left in; empty: not known of one that
/// bears load and did before. Those that close there carry nothing yet where nothing is said of
/// them.
StanceWrenches wrenches_at(const Graph& graph, const Plan& plan, std::size_t i) {
  if (!plan.stance_from[i] || plan.index.wrenches[i].empty()) return {};
  const StanceParameter& stance = *plan.stance_from[i];
  const VertexWrenches& given =
      graph.vertex(VertexId<VertexWrenches>{plan.index.wrenches[i].front()});
  StanceWrenches wrenches(stance.contacts.size(), StanceWrenches::value_type::Zero());
  std::vector<bool> stated(stance.contacts.size(), false);
  Eigen::Index at = 0;
  for (std::size_t c = 0; c < given.contact_numbers.size(); ++c) {
    const std::span<const int> components = (*given.contacts)[c]->cone->components();
    const auto found = std::ranges::find(stance.contact_numbers, given.contact_numbers[c]);
    if (found != stance.contact_numbers.end()) {
      const auto k = static_cast<std::size_t>(found - stance.contact_numbers.begin());
      for (std::size_t n = 0; n < components.size(); ++n) {
        wrenches[k][components[n]] = given.state[at + static_cast<Eigen::Index>(n)];
      }
      stated[k] = true;
    }
    at += static_cast<Eigen::Index>(components.size());
  }
  for (std::size_t k = 0; k < stated.size(); ++k) {
    const bool closes = i > 0 && plan.stance_from[i - 1] &&
                        std::ranges::count(plan.stance_from[i - 1]->contact_numbers,
                                           stance.contact_numbers[k]) == 0;
    if (!stated[k] && stance.contacts[k]->contact.bears_load && !closes) return {};
  }
  return wrenches;
}

std::string text_of(const ContactParameter& contact) {
  FieldWriter out;
  contact.write(out);
  return out.text();
}

}  // namespace

Plan plan_of(const Graph& graph) {
  Plan plan;
  const Parameters& parameters = graph.parameters();
  for (int slot = 0; slot < graph.vertex_slots(); ++slot) {
    if (graph.vertex_alive(slot) && vertex_is<VertexConfiguration>(graph, slot)) {
      plan.slots.push_back(slot);
    }
  }
  if (plan.slots.empty()) throw Error("the graph holds no plan", "VERTEX_CONFIGURATION lines");
  const auto format = only<PlanParameter>(parameters);
  if (!format) throw Error("a plan without a format version", "a PARAMS_PLAN line");
  only<ScenarioParameter>(parameters);
  only<ContactsParameter>(parameters);
  only<RecordParameter>(parameters);
  plan.incomplete = format->incomplete;
  plan.recorded = format->recorded;
  plan.moves = format->moves;
  plan.world = only<WorldParameter>(parameters);
  if (plan.world) plan.world_number = *parameters.number_of<WorldParameter>();
  only<RobotParameter>(parameters);
  plan.says_stances_only = format->stances_only;
  plan.stances_only = plan.says_stances_only && is_stance_sequence(graph, plan.slots);
  if (!plan.stances_only) {
    std::stable_sort(plan.slots.begin(), plan.slots.end(), [&graph](int a, int b) {
      return configuration(graph, a).time_s < configuration(graph, b).time_s;
    });
  }
  plan.robot = configuration(graph, plan.slots.front()).robot;
  for (const int slot : plan.slots) {
    const VertexConfiguration& vertex = configuration(graph, slot);
    if (vertex.robot != plan.robot) {
      throw Error("", graph.vertex_record(slot).line,
                  "the plan has configurations of several robots", "one robot");
    }
    const bool known = vertex.stance_number != kNoStance;
    plan.stance_from.push_back(known ? parameters.get<StanceParameter>(vertex.stance_number)
                                     : nullptr);
  }
  for (int slot = 0; slot < graph.vertex_slots(); ++slot) {
    plan.states_wrenches = plan.states_wrenches ||
                           (graph.vertex_alive(slot) && vertex_is<VertexWrenches>(graph, slot));
  }
  plan.index = plan_index(graph, plan.slots);
  require_wrenches_of_stances(graph, plan);
  plan.segments = segments_of(graph, plan);
  for (std::size_t j = 0; j < plan.segments.size(); ++j) {
    const auto begin = plan.index.segment.begin() + plan.segments[j].first;
    std::fill(begin, plan.index.segment.begin() + plan.segments[j].last + 1, static_cast<int>(j));
  }
  return plan;
}

std::vector<Eigen::VectorXd> tracked_configurations(const Graph& graph, const Plan& plan) {
  std::vector<Eigen::VectorXd> tracked(plan.slots.size());
  for (const EdgePlanTracking& edge : graph.edges_of<EdgePlanTracking>()) {
    const int i = plan.index.configuration[static_cast<std::size_t>(edge.vertices[0])];
    Eigen::VectorXd& here = tracked[static_cast<std::size_t>(i)];
    if (here.size() == 0) here = edge.reference;
  }
  return tracked;
}

int held_since(const std::vector<std::shared_ptr<const StanceParameter>>& stance_from, int contact,
               int configuration) {
  const auto is_held = [&](int i) {
    const auto& stance = stance_from[static_cast<std::size_t>(i)];
    return stance && std::ranges::count(stance->contact_numbers, contact) > 0;
  };
  while (configuration > 0 && is_held(configuration - 1)) --configuration;
  return configuration;
}

std::vector<int> contacts_at(const std::vector<std::shared_ptr<const StanceParameter>>& stance_from,
                             std::size_t i) {
  std::vector<int> numbers;
  for (const std::size_t step : {i, i == 0 ? i : i - 1}) {
    if (!stance_from[step]) continue;
    for (const int number : stance_from[step]->contact_numbers) {
      if (std::ranges::find(numbers, number) == numbers.end()) numbers.push_back(number);
    }
  }
  return numbers;
}

void mark_incomplete(Graph& graph) {
  cut_segments(graph);
  const auto number = graph.parameters().number_of<PlanParameter>();
  if (!number) return;
  const auto marked =
      std::make_shared<PlanParameter>(*graph.parameters().get<PlanParameter>(*number));
  marked->incomplete = true;
  graph.parameters().replace(*number, marked);
}

Motion motion_of(const Graph& graph, const Plan& plan) {
  return motion_of(graph, plan, 0, static_cast<int>(plan.slots.size()) - 1);
}

Motion motion_of(const Graph& graph, const Plan& plan, int first, int last) {
  Motion motion;
  motion.stances_only = plan.stances_only;
  std::map<const StanceParameter*, int> known;
  for (auto i = static_cast<std::size_t>(first); i <= static_cast<std::size_t>(last); ++i) {
    const VertexConfiguration& vertex = configuration(graph, plan.slots[i]);
    motion.time_s.push_back(vertex.time_s);
    motion.configurations.push_back(vertex.state);
    motion.slopes.push_back(vertex.slopes);
    if (plan.states_wrenches) motion.wrenches.push_back(wrenches_at(graph, plan, i));
    const StanceParameter* stance = plan.stance_from[i].get();
    if (stance == nullptr) {
      motion.stance_from.push_back(-1);
      continue;
    }
    const auto [found, added] = known.emplace(stance, static_cast<int>(motion.stances.size()));
    if (added) motion.stances.push_back(stance->stance);
    motion.stance_from.push_back(found->second);
  }
  return motion;
}

std::vector<int> add_stances(Graph& graph, const std::shared_ptr<const RobotParameter>& robot,
                             const std::vector<Stance>& stances) {
  Parameters& parameters = graph.parameters();
  parameters.set(kPlanNumber, std::make_shared<const PlanParameter>());
  std::map<std::string, int> numbers;
  std::vector<std::vector<int>> contacts_of;
  int next = kFirstContact;
  for (const Stance& stance : stances) {
    std::vector<int>& contacts = contacts_of.emplace_back();
    for (const Contact& contact : stance.contacts) {
      const auto parameter = std::make_shared<const ContactParameter>(robot, kRobotNumber, contact);
      const auto [found, added] = numbers.emplace(text_of(*parameter), next);
      if (added) parameters.set(next++, parameter);
      contacts.push_back(found->second);
    }
  }
  std::vector<int> result;
  for (std::vector<int>& contacts : contacts_of) {
    parameters.set(next, std::make_shared<const StanceParameter>(parameters, std::move(contacts)));
    result.push_back(next++);
  }
  return result;
}

}  // namespace locograph
