#pragma once
/// Parameters: what many edges or vertices share (a sensor's offset, a robot, a map), by number.
///
///     struct RangeOffset : Parameter {
///       double offset_m = 0.0;
///       std::string_view tag() const override { return "PARAMS_RANGE_OFFSET"; }
///       void read(FieldReader& in) override { offset_m = in.number(); }
///       void write(FieldWriter& out) const override { out.number(offset_m); }
///     };
///
///     graph.parameters().set(0, std::make_shared<RangeOffset>());
///     auto offset = graph.parameters().get<RangeOffset>(0);
///
/// In a file a parameter is one line `TAG number fields…`. Parameters are immutable once set.

#include <locograph/core/fields.h>

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <typeindex>
#include <typeinfo>

namespace locograph {

class Parameter {
 public:
  virtual ~Parameter() = default;
  virtual std::string_view tag() const = 0;
  virtual void read(FieldReader& in) = 0;
  virtual void write(FieldWriter& out) const = 0;
};

class Parameters {
 public:
  /// line: of the file that it was read from. Throws Error when the number is taken.
  void set(int number, std::shared_ptr<const Parameter> parameter, int line = 0) {
    if (all_.contains(number)) {
      throw Error("parameter " + std::to_string(number) + " is given twice", "one definition");
    }
    replace(number, std::move(parameter));
    if (line > 0) lines_[number] = line;
  }
  void replace(int number, std::shared_ptr<const Parameter> parameter) {
    forget_type(number);
    const Parameter& added = *parameter;
    numbers_[typeid(added)].insert(number);
    all_[number] = std::move(parameter);
  }
  void remove(int number) {
    forget_type(number);
    all_.erase(number);
    lines_.erase(number);
  }

  /// Throws Error when there is none, or when it is of another type.
  template <class P>
  std::shared_ptr<const P> get(int number) const {
    const auto found = all_.find(number);
    if (found == all_.end()) {
      throw Error("unknown parameter " + std::to_string(number),
                  "a number declared by a PARAMS line");
    }
    std::shared_ptr<const P> typed = std::dynamic_pointer_cast<const P>(found->second);
    if (!typed) {
      throw Error(
          "parameter " + std::to_string(number) + " is a " + std::string(found->second->tag()),
          "another type of parameter");
    }
    return typed;
  }

  /// Of the parameters of type P, ascending; does not look at others. A copy: they may be replaced
  /// and removed while it is gone through.
  template <class P>
  std::set<int> numbers_of() const {
    static_assert(std::is_final_v<P>, "a type that others derive from has no list of its own");
    const auto found = numbers_.find(typeid(P));
    return found == numbers_.end() ? std::set<int>() : found->second;
  }
  /// The lowest of them, if there is any.
  template <class P>
  std::optional<int> number_of() const {
    const auto found = numbers_.find(typeid(P));
    if (found == numbers_.end() || found->second.empty()) return std::nullopt;
    return *found->second.begin();
  }
  /// That parameter, null when there is none.
  template <class P>
  std::shared_ptr<const P> find() const {
    const std::optional<int> number = number_of<P>();
    return number ? get<P>(*number) : nullptr;
  }

  const std::map<int, std::shared_ptr<const Parameter>>& all() const { return all_; }
  /// Where a parameter was read; 0 where it was not read from a file.
  int line(int number) const {
    const auto found = lines_.find(number);
    return found == lines_.end() ? 0 : found->second;
  }

 private:
  void forget_type(int number) {
    const auto found = all_.find(number);
    if (found == all_.end()) return;
    const Parameter& old = *found->second;
    numbers_[typeid(old)].erase(number);
  }

  std::map<int, std::shared_ptr<const Parameter>> all_;
  std::map<std::type_index, std::set<int>> numbers_;
  std::map<int, int> lines_;
};

}  // namespace locograph
