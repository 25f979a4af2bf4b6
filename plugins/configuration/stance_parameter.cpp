#include <locograph/common/ranges.h>
#include <locograph/plugins/configuration/stance_parameter.h>

namespace locograph {

std::vector<StanceParameter::StandingWheel> standing_wheels(const Robot& robot,
                                                            const Stance& stance) {
  std::vector<StanceParameter::StandingWheel> wheels;
  for (const Contact& contact : stance.contacts) {
    if (contact.effector.kind != ContactKind::kWheel) continue;
    wheels.push_back(
        {wheel_of(robot, contact.effector), contact.normal.stableNormalized(), contact.locked});
  }
  return wheels;
}

StanceParameter::StanceParameter(const Parameters& parameters, std::vector<int> numbers)
    : contact_numbers(std::move(numbers)) {
  for (const int number : contact_numbers) {
    contacts.push_back(parameters.get<ContactParameter>(number));
    if (contacts.back()->robot != contacts.front()->robot) {
      throw Error("a stance of contacts of different robots", "one robot");
    }
    stance.contacts.push_back(contacts.back()->contact);
  }
  if (contacts.empty()) throw Error("a stance without contacts", "at least one");
  robot = contacts.front()->robot;
  require_sound_stance(*robot->robot, stance);
  wheels = standing_wheels(*robot->robot, stance);
}

void StanceParameter::read(FieldReader& in) {
  const int count = in.integer();
  if (count < 1 || count > ranges::kContacts) {
    in.fail("number of contacts " + std::to_string(count),
            "at least one, at most " + std::to_string(ranges::kContacts));
  }
  std::vector<int> numbers;
  for (int i = 0; i < count; ++i) numbers.push_back(in.integer());
  *this = StanceParameter(*in.parameters(), std::move(numbers));
}

void StanceParameter::write(FieldWriter& out) const {
  out.integer(static_cast<long>(contact_numbers.size()));
  for (const int number : contact_numbers) out.integer(number);
}

}  // namespace locograph
