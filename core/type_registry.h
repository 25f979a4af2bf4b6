#pragma once
/// Which types a graph file may name: tags of vertices, edges and parameters.
///
///     TypeRegistry types = standard_types();          // from locograph/types/standard_types.h
///     types.add_vertex<VertexBeacon>();
///     types.add_edge<EdgeRange>();
///     types.add_parameter<RangeOffset>("PARAMS_RANGE_OFFSET");
///     Graph graph = read_graph("map.g2o", types);
///
/// A value: made where it is needed and passed on; there is no global registry. A tag or a type
/// that is taken is an Error. Libraries loaded at run time add theirs by plugin_library.h.

#include <locograph/core/typed_edge_pool.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace locograph {

class TypeRegistry {
 public:
  template <class V>
  void add_vertex() {
    const std::string tag(locograph_tag(static_cast<const V*>(nullptr)));
    check_new(tag, typeid(V), vertex_tags_);
    add_vertex(tag, typeid(V),
               [] { return std::unique_ptr<VertexPool>(std::make_unique<TypedVertexPool<V>>()); });
  }
  /// A second tag for V; a vertex read under it is written under it.
  template <class V>
  void add_vertex_alias(const std::string& tag) {
    add_vertex(tag, typeid(V),
               [] { return std::unique_ptr<VertexPool>(std::make_unique<TypedVertexPool<V>>()); });
  }
  template <class E>
  void add_edge() {
    const std::string tag(locograph_tag(static_cast<const E*>(nullptr)));
    check_new(tag, typeid(E), edge_tags_);
    add_edge(tag, [] { return std::unique_ptr<EdgePool>(std::make_unique<TypedEdgePool<E>>()); });
  }
  /// A second tag for E, which was added before; an edge read under it is written under E's own.
  template <class E>
  void add_edge_alias(const std::string& tag) {
    add_edge_alias(tag, std::string(locograph_tag(static_cast<const E*>(nullptr))));
  }
  /// An edge type that brings its own pool (dense_prior.h).
  template <class Pool>
  void add_edge_pool() {
    add_edge(std::string(Pool::kTag),
             [] { return std::unique_ptr<EdgePool>(std::make_unique<Pool>()); });
  }
  template <class P>
  void add_parameter(const std::string& tag) {
    add_parameter(tag, [] { return std::unique_ptr<Parameter>(std::make_unique<P>()); });
  }

  /// A tag that files had once: it is refused, saying what is expected instead.
  void retire(const std::string& tag, const std::string& expected);

  struct VertexType {
    std::type_index type;
    std::function<std::unique_ptr<VertexPool>()> make_pool;
  };
  using MakeEdgePool = std::function<std::unique_ptr<EdgePool>()>;
  using MakeParameter = std::function<std::unique_ptr<Parameter>()>;

  const VertexType* vertex_type(const std::string& tag) const;
  const MakeEdgePool* edge_type(const std::string& tag) const;
  const MakeParameter* parameter_type(const std::string& tag) const;
  /// What is expected instead of a tag that was retired; null for others.
  const std::string* retired(const std::string& tag) const;
  /// All tags that are not retired, sorted.
  std::vector<std::string> tags() const;

 private:
  void add_vertex(const std::string& tag, std::type_index type,
                  std::function<std::unique_ptr<VertexPool>()> make);
  void add_edge(const std::string& tag, MakeEdgePool make);
  void add_edge_alias(const std::string& alias, const std::string& tag);
  void add_parameter(const std::string& tag, MakeParameter make);
  void check_free(const std::string& tag) const;
  /// Pools tell types apart by std::type_index, that is by name: two libraries may each have a
  /// class of the same name, but not in one registry.
  static void check_new(const std::string& tag, std::type_index type,
                        std::map<std::type_index, std::string>& tags);

  std::map<std::string, VertexType> vertices_;
  std::map<std::string, MakeEdgePool> edges_;
  std::map<std::string, MakeParameter> parameters_;
  std::map<std::string, std::string> retired_;
  std::map<std::type_index, std::string> vertex_tags_, edge_tags_;  ///< of the types themselves
};

}  // namespace locograph
