#include <locograph/robots/contact_closure.h>
#include <locograph/robots/contact_kinds.h>

namespace locograph {

std::optional<ContactRowLabel> ClosureRows::label(int) const { return std::nullopt; }

ContactClosure::ContactClosure(const Robot& robot, const Contact& contact) {
  require_sound_contact(robot, contact);
  rows_ = contact_kind_entry(contact.effector.kind).closure(robot, contact);
}

}  // namespace locograph
