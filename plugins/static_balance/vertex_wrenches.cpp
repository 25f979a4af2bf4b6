#include <locograph/common/ranges.h>
#include <locograph/core/graph.h>
#include <locograph/plugins/static_balance/vertex_wrenches.h>

#include <algorithm>
#include <cmath>

namespace locograph {

VertexWrenches::VertexWrenches(const Parameters& parameters, std::vector<int> numbers)
    : contact_numbers(std::move(numbers)) {
  if (contact_numbers.empty()) throw Error("wrenches at no contact", "at least one");
  ContactList list;
  Eigen::Index size = 0;
  for (std::size_t i = 0; i < contact_numbers.size(); ++i) {
    const int number = contact_numbers[i];
    if (std::count(contact_numbers.begin(), contact_numbers.end(), number) > 1) {
      throw Error("wrenches at contact " + std::to_string(number) + " twice", "once");
    }
    list.push_back(parameters.get<ContactParameter>(number));
    if (!list.back()->contact.bears_load) {
      throw Error("wrenches at contact " + std::to_string(number) + ", which is unloaded",
                  "contacts that bear load");
    }
    if (list.back()->robot != list.front()->robot) {
      throw Error("wrenches at contacts of different robots", "one robot");
    }
    size += static_cast<Eigen::Index>(list.back()->cone->components().size());
  }
  contacts = std::make_shared<const ContactList>(std::move(list));
  state.setZero(size);
}

WrenchesState VertexWrenches::make_derived() const {
  // A file with edges only makes vertices that know no contacts.
  if (!contacts) throw Error("wrenches without contacts", "a VERTEX_WRENCHES that names them");
  return {contacts, state};
}

void VertexWrenches::read(FieldReader& in) {
  const int count = in.integer();
  if (count < 1) in.fail("number of contacts " + std::to_string(count), "at least one");
  std::vector<int> numbers;
  for (int i = 0; i < count; ++i) numbers.push_back(in.integer());
  *this = VertexWrenches(*in.parameters(), std::move(numbers));
  for (double& component : state) {
    const std::string_view text = in.peek();
    component = in.number();
    if (std::abs(component) > ranges::kWrench) {
      in.fail("a wrench of " + std::string(text) + " is beyond all forces", "up to 1e9");
    }
  }
}

void VertexWrenches::write(FieldWriter& out) const {
  out.integer(static_cast<long>(contact_numbers.size()));
  for (const int number : contact_numbers) out.integer(number);
  for (Eigen::Index i = 0; i < state.size(); ++i) out.number(state[i]);
}

int mark_wrenches_for_elimination(Graph& graph) {
  int marked = 0;
  for (int slot = 0; slot < graph.vertex_slots(); ++slot) {
    if (!graph.vertex_alive(slot)) continue;
    const VertexPool& pool = *graph.vertex_pools()[graph.vertex_record(slot).pool];
    if (pool.type() != typeid(VertexWrenches)) continue;
    graph.set_eliminate(slot, true);
    ++marked;
  }
  return marked;
}

}  // namespace locograph
