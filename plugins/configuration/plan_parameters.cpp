#include <locograph/plugins/configuration/path_field.h>
#include <locograph/plugins/configuration/plan_parameters.h>

namespace locograph {

void refuse_older_plan(const FieldReader& in, std::string_view tag) {
  in.fail(std::string(tag) + " of a plan of format version 1",
          "format version " + std::to_string(kPlanFormat) + ": make the plan again");
}

void PlanParameter::read(FieldReader& in) {
  const int version = in.integer();
  if (version != kPlanFormat) {
    in.fail("a plan of format version " + std::to_string(version),
            "version " + std::to_string(kPlanFormat));
  }
  while (!in.at_end()) {
    const std::string word = in.word();
    if (word == "stances_only") {
      stances_only = true;
    } else if (word == "incomplete") {
      incomplete = true;
    } else {
      in.fail("'" + word + "'", "'stances_only', 'incomplete' or the end of the line");
    }
  }
}

void PlanParameter::write(FieldWriter& out) const {
  out.integer(kPlanFormat);
  if (stances_only) out.word("stances_only");
  if (incomplete) out.word("incomplete");
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

}  // namespace locograph
