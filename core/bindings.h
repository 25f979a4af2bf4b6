#pragma once
/// Parameters that stand in for those of the graph while a workspace evaluates it.
///
///     auto moved = std::make_shared<RangeOffset>();
///     moved->offset_m = 0.1;
///     Bindings bindings;
///     bindings.set(0, moved);                    // in the place of parameter 0 of the graph
///     workspace.bind(bindings);                  // others that evaluate the graph do not see it
///     workspace.evaluate(workspace.state());
///
/// For what changes while a graph is optimised again and again, as the world around a robot does:
/// the parameter in the graph stays as it is, the compiled problem too. Edges that want to know ask
/// for it, see edge.h; all others read the graph's own.

#include <locograph/core/parameters.h>

#include <algorithm>
#include <cassert>
#include <utility>
#include <vector>

namespace locograph {

class Bindings {
 public:
  /// Keeps its memory.
  void clear() { all_.clear(); }
  void set(int number, std::shared_ptr<const Parameter> parameter) {
    const auto found = std::ranges::find(all_, number, &Binding::number);
    if (found == all_.end()) {
      all_.push_back({number, std::move(parameter)});
    } else {
      found->parameter = std::move(parameter);
    }
  }

  /// The same parameters for the same numbers.
  bool operator==(const Bindings&) const = default;

  /// What stands in for the graph's parameter of that number; `own`, where nothing does.
  template <class P>
  const P& get(int number, const P& own) const {
    for (const Binding& binding : all_) {
      if (binding.number != number) continue;
      assert(dynamic_cast<const P*>(binding.parameter.get()) != nullptr);
      return static_cast<const P&>(*binding.parameter);
    }
    return own;
  }

  /// Throws Error for a number that `parameters` does not have, or has with another type.
  void require_fit(const Parameters& parameters) const {
    for (const Binding& binding : all_) {
      const Parameter &own = *parameters.get<Parameter>(binding.number),
                      &bound = *binding.parameter;
      if (typeid(own) == typeid(bound)) continue;
      throw Error(
          "a " + std::string(bound.tag()) + " bound to parameter " + std::to_string(binding.number),
          "a " + std::string(own.tag()));
    }
  }

 private:
  struct Binding {
    int number;
    std::shared_ptr<const Parameter> parameter;
    bool operator==(const Binding&) const = default;
  };

  std::vector<Binding> all_;
};

}  // namespace locograph
