#include <locograph/plugins/configuration/path_field.h>
#include <locograph/plugins/configuration/plan_parameters.h>

#include <charconv>
#include <set>

namespace locograph {
namespace {

ContactMoves read_moves(FieldReader& in) {
  ContactMoves moves;
  moves.most_m = in.number();
  if (!(moves.most_m > 0.0 && moves.most_m <= ContactMoves::kFurthest_m)) {
    in.fail("contacts moved by up to " + std::to_string(moves.most_m) + " m",
            "more than 0 m, and 10 m at most");
  }
  const std::string seed = in.word();
  const char* const end = seed.data() + seed.size();
  const std::from_chars_result parsed = std::from_chars(seed.data(), end, moves.seed);
  if (parsed.ec != std::errc() || parsed.ptr != end) {
    in.fail("the seed '" + seed + "'", "a whole number");
  }
  moves.draws = in.integer();
  if (moves.draws < 1 || moves.draws > kMostDraws) {
    in.fail("draw " + std::to_string(moves.draws), "1 to " + std::to_string(kMostDraws));
  }
  return moves;
}

ExecutionMargin read_margin(FieldReader& in) {
  ExecutionMargin margin;
  for (double* number : {&margin.friction, &margin.area, &margin.torque, &margin.joint_rad,
                         &margin.least_force, &margin.dwell_s}) {
    *number = in.number();
  }
  margin.self_distance_m = 0.0;
  return margin;
}

void require_sound(const ExecutionMargin& margin, const FieldReader& in) {
  try {
    margin.validate();
  } catch (const Error& error) {
    in.fail(std::string("an execution margin: ") + error.what(), "");
  }
}

}  // namespace

void refuse_older_plan(const FieldReader& in, std::string_view tag) {
  in.fail(std::string(tag) + " of a plan of format version 1",
          "format version " + std::to_string(kPlanFormat) + ": make the plan again");
}

void PlanParameter::read(FieldReader& in) {
  const int version = in.integer();
  if (version < kOldestPlanFormat || version > kPlanFormat) {
    in.fail("a plan of format version " + std::to_string(version),
            "version " + std::to_string(kOldestPlanFormat) + " or " + std::to_string(kPlanFormat));
  }
  std::set<std::string> seen;
  while (!in.at_end()) {
    const std::string word = in.word();
    if (!seen.insert(word).second) in.fail("a second '" + word + "'", "it once");
    if (word == "stances_only") {
      stances_only = true;
    } else if (word == "incomplete") {
      incomplete = true;
    } else if (word == "recorded") {
      recorded = true;
    } else if (word == "moved_contacts") {
      moves = read_moves(in);
    } else if (word == "execution_margin") {
      margin = read_margin(in);
      require_sound(margin, in);
    } else if (word == "self_distance" && seen.contains("execution_margin")) {
      margin.self_distance_m = in.number();
      require_sound(margin, in);
    } else {
      in.fail(
          "'" + word + "'",
          "'stances_only', 'incomplete', 'recorded', 'moved_contacts', 'execution_margin', after "
          "that 'self_distance', or the end of the line");
    }
  }
  if (recorded && stances_only) in.fail("a record of stances only", "of a motion");
}

void PlanParameter::write(FieldWriter& out) const {
  out.integer(kPlanFormat);
  if (stances_only) out.word("stances_only");
  if (incomplete) out.word("incomplete");
  if (recorded) out.word("recorded");
  if (moves.most_m > 0.0) {
    out.word("moved_contacts");
    out.number(moves.most_m);
    out.word(std::to_string(moves.seed));
    out.integer(moves.draws);
  }
  if (margin == ExecutionMargin::none()) return;
  out.word("execution_margin");
  for (const double number : {margin.friction, margin.area, margin.torque, margin.joint_rad,
                              margin.least_force, margin.dwell_s}) {
    out.number(number);
  }
  if (margin.self_distance_m == 0.0) return;
  out.word("self_distance");
  out.number(margin.self_distance_m);
}

void ScenarioParameter::read(FieldReader& in) {
  scenario = in.word();
  if (scenario.find('/') == std::string::npos) return;
  const std::filesystem::path path(scenario);
  if (path.is_relative()) scenario = (in.where().folder / path).string();
  // A folder that is not named: a path all the same.
  if (scenario.find('/') == std::string::npos) scenario = "./" + scenario;
}

void ScenarioParameter::write(FieldWriter& out) const {
  if (scenario.find('/') == std::string::npos) {
    out.word(scenario);
    return;
  }
  std::string word = relative_to_file(out, scenario);
  if (word.find('/') == std::string::npos) word = "./" + word;
  out.word(word);
}

void ContactsParameter::read(FieldReader& in) { file = read_path(in); }
void ContactsParameter::write(FieldWriter& out) const { write_path(out, file); }

void RecordParameter::read(FieldReader& in) { plan = read_path(in); }
void RecordParameter::write(FieldWriter& out) const { write_path(out, plan); }

}  // namespace locograph
