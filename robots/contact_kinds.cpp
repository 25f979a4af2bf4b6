#include <locograph/common/error.h>
#include <locograph/robots/contact_kinds.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace locograph {
namespace {

struct KindTable {
  std::array<const ContactKindEntry*, 64> entries = {
#define LOCOGRAPH_CONTACT_ENTRY(enumerator, entry) &entry(),
      LOCOGRAPH_CONTACT_KINDS(LOCOGRAPH_CONTACT_ENTRY)
#undef LOCOGRAPH_CONTACT_ENTRY
  };
  std::size_t count = static_cast<std::size_t>(std::find(entries.begin(), entries.end(), nullptr) -
                                               entries.begin());

  std::span<const ContactKindEntry* const> all() const { return {entries.data(), count}; }
};

KindTable& kind_table() {
  static KindTable table;
  return table;
}

bool has(const std::vector<EffectorField>& fields, double EndEffector::*value) {
  return std::ranges::any_of(fields, [&](const EffectorField& one) { return one.value == value; });
}

}  // namespace

ContactKindEntry::ContactKindEntry(std::string kind_name, std::vector<EffectorField> kind_fields)
    : name(std::move(kind_name)),
      fields(std::move(kind_fields)),
      has_area_(has(fields, &EndEffector::half_x_m)),
      is_round_(has(fields, &EndEffector::radius_m)),
      has_friction_(has(fields, &EndEffector::friction)) {}

void ContactKindEntry::require_sound(const Robot&, const EndEffector&) const {}

Eigen::Vector2d ContactKindEntry::inset_m(const EndEffector&) const {
  return Eigen::Vector2d::Zero();
}

Eigen::Vector3d ContactKindEntry::touching_point(const RobotState&, const Contact& contact) const {
  return contact.position;
}

const ContactKindEntry& contact_kind_entry(ContactKind kind) {
  const auto number = static_cast<std::size_t>(kind);
  const std::span<const ContactKindEntry* const> all = kind_table().all();
  if (number < all.size()) return *all[number];
  throw Error("contact kind " + std::to_string(number), "one of the table");
}

double area_reach_m(const EndEffector& effector) {
  if (!contact_kind_entry(effector.kind).has_area()) return 0.0;
  return std::hypot(effector.half_x_m, effector.half_y_m);
}

ContactKind add_contact_kind(const ContactKindEntry& entry) {
  KindTable& table = kind_table();
  if (contact_kind_of(entry.name)) {
    throw Error("a second contact kind '" + entry.name + "'", "each name once");
  }
  if (table.count == table.entries.size()) {
    throw Error("contact kind " + std::to_string(table.count), "fewer");
  }
  table.entries[table.count] = &entry;
  return static_cast<ContactKind>(table.count++);
}

const std::string& contact_kind_name(ContactKind kind) { return contact_kind_entry(kind).name; }

std::optional<ContactKind> contact_kind_of(const std::string& name) {
  const std::span<const ContactKindEntry* const> all = kind_table().all();
  const auto found = std::ranges::find(all, name, &ContactKindEntry::name);
  if (found == all.end()) return std::nullopt;
  return static_cast<ContactKind>(found - all.begin());
}

std::string contact_kind_names(const std::string& quote) {
  std::string text;
  const std::span<const ContactKindEntry* const> all = kind_table().all();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i > 0) text += i + 1 < all.size() ? ", " : " or ";
    text += quote + all[i]->name + quote;
  }
  return text;
}

}  // namespace locograph
