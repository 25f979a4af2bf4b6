#include <locograph/robots/bearing_rays.h>
#include <locograph/robots/contact_kinds.h>

namespace locograph {

std::vector<BearingRay> bearing_rays(const BearingContact& bearing, double margin,
                                     double weight_N) {
  return contact_kind_entry(bearing.contact.effector.kind).rays(bearing, 1.0 - margin, weight_N);
}

double most_of_rays(const Contact& contact, double margin, double weight_N) {
  if (!contact_kind_entry(contact.effector.kind).pressed) return -1.0;
  return (1.0 - margin) * contact.effector.max_force_N / weight_N;
}

double least_of_rays(const BearingContact& bearing, double weight_N) {
  if (!contact_kind_entry(bearing.contact.effector.kind).pressed) return 0.0;
  return bearing.least_N / weight_N;
}

}  // namespace locograph
