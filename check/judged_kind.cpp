#include <locograph/check/judged_kind.h>
#include <locograph/common/error.h>

namespace locograph {

void require_judged_kind(const EndEffector& effector) {
  switch (effector.kind) {
    case ContactKind::kSurface:
    case ContactKind::kPoint:
    case ContactKind::kGrasp:
    case ContactKind::kWheel:
      return;
  }
  throw Error("contact of " + (effector.name.empty() ? effector.link : effector.name) + " is a " +
                  contact_kind_name(effector.kind) + ", which the judge has no rules for",
              "surface, point, rung or wheel");
}

}  // namespace locograph
