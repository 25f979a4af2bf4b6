#pragma once
/// The kinds of contact that the judge has rules for.

#include <locograph/robots/contact.h>

namespace locograph {

/// Throws Error for another kind: what is not judged must not pass. A kind that is new in
/// robots/contact_kinds is a compiler's warning in each switch of the judge, and an error here
/// until it has its rules.
void require_judged_kind(const EndEffector& effector);

}  // namespace locograph
