#pragma once
/// Contact tasks that come along as stance planners take them, changed at will.
///
///     Task task = stance_task("standing_up");
///     Task slippery = stance_task("standing_up", {{"friction=\"0.5\"",
///     "friction=\"0.1\""}}); Contact& hand = contact_of(task.start, "left_hand");

#include <locograph/planners/offline/stance/started_task.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "planners/scenario_texts.h"

namespace locograph::test {

using Replacements = std::vector<std::pair<std::string, std::string>>;

/// The scenario that comes along with the first of each text replaced.
inline Scenario changed_scenario(const std::string& name, const Replacements& replacements) {
  std::ifstream in(LOCOGRAPH_SOURCE_DIR "/planners/scenarios/" + name + ".xml");
  std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  for (const auto& [find, replace] : replacements) text = with(text, find, replace);
  return scenario_of(text);
}

/// Without an execution margin.
inline Task stance_task(const std::string& name, const Replacements& replacements = {}) {
  Scenario scenario = changed_scenario(name, replacements);
  scenario.margin = ExecutionMargin::none();
  return started_task(scenario).task;
}

inline Task stance_task_with_margin(const std::string& name) {
  return started_task(changed_scenario(name, {})).task;
}

inline Contact& contact_of(Stance& stance, const std::string& name) {
  const auto found = std::ranges::find(stance.contacts, name, &Contact::name);
  if (found == stance.contacts.end()) throw std::invalid_argument("no contact of " + name);
  return *found;
}

inline Stance without_contact(Stance stance, const std::string& name) {
  std::erase_if(stance.contacts, [&](const Contact& contact) { return contact.name() == name; });
  return stance;
}

}  // namespace locograph::test
