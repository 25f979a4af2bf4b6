#include <locograph/core/type_registry.h>

#include <algorithm>

namespace locograph {
namespace {

template <class Map>
auto* look_up(const Map& map, const std::string& tag) {
  const auto found = map.find(tag);
  return found == map.end() ? nullptr : &found->second;
}

}  // namespace

void TypeRegistry::check_free(const std::string& tag) const {
  if (tag.empty() || tag.find_first_of(" \t#") != std::string::npos) {
    throw Error("tag '" + tag + "' cannot stand in a graph file", "one word");
  }
  if (vertices_.contains(tag) || edges_.contains(tag) || parameters_.contains(tag) ||
      retired_.contains(tag) || tag == "FIX") {
    throw Error("tag " + tag + " is registered twice", "a tag that is not taken");
  }
}

void TypeRegistry::check_new(const std::string& tag, std::type_index type,
                             std::map<std::type_index, std::string>& tags) {
  const auto [known, added] = tags.emplace(type, tag);
  if (!added && known->second != tag) {
    throw Error("the classes of " + tag + " and " + known->second + " have the same name",
                "one tag for each class (aliases aside)");
  }
}

void TypeRegistry::add_vertex(const std::string& tag, std::type_index type,
                              std::function<std::unique_ptr<VertexPool>()> make) {
  check_free(tag);
  vertices_.emplace(tag, VertexType{type, std::move(make)});
}
void TypeRegistry::add_edge(const std::string& tag, MakeEdgePool make) {
  check_free(tag);
  edges_.emplace(tag, std::move(make));
}
void TypeRegistry::add_edge_alias(const std::string& alias, const std::string& tag) {
  const MakeEdgePool* known = edge_type(tag);
  if (known == nullptr) throw Error("unknown edge type " + tag, "a type that was added before");
  add_edge(alias, MakeEdgePool(*known));
}
void TypeRegistry::add_parameter(const std::string& tag, MakeParameter make) {
  check_free(tag);
  parameters_.emplace(tag, std::move(make));
}

const TypeRegistry::VertexType* TypeRegistry::vertex_type(const std::string& tag) const {
  return look_up(vertices_, tag);
}
const TypeRegistry::MakeEdgePool* TypeRegistry::edge_type(const std::string& tag) const {
  return look_up(edges_, tag);
}
const TypeRegistry::MakeParameter* TypeRegistry::parameter_type(const std::string& tag) const {
  return look_up(parameters_, tag);
}

void TypeRegistry::retire(const std::string& tag, const std::string& expected) {
  check_free(tag);
  retired_.emplace(tag, expected);
}
const std::string* TypeRegistry::retired(const std::string& tag) const {
  return look_up(retired_, tag);
}

std::vector<std::string> TypeRegistry::tags() const {
  std::vector<std::string> all;
  for (const auto& entry : vertices_) all.push_back(entry.first);
  for (const auto& entry : edges_) all.push_back(entry.first);
  for (const auto& entry : parameters_) all.push_back(entry.first);
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace locograph
