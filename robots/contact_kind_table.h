#pragma once
/// The table of the kinds of contact: a line a kind, with its enumerator and the function that
/// returns its entry (contact_kinds.h), which stands in a file of its own beside this one.
/// doc/contact_kinds.md says how a kind is added.

#define LOCOGRAPH_CONTACT_KINDS(KIND) \
  KIND(kSurface, surface_contact)     \
  KIND(kPoint, point_contact)         \
  KIND(kGrasp, grasp_contact)         \
  KIND(kWheel, wheel_contact)
