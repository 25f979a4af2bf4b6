#pragma once
/// How often moves like one were found: of the same length; to the same side of the same other
/// contact. And how often an end effector's torques let it be lifted from such a side of others.
///
///     Experience experience(space);
///     experience.learn(footing, effector, place, 0.4, found);
///     cost += experience.unlikelihood(footing, effector, other_place, 0.4);

#include <locograph/planners/offline/stance/stance_space.h>

#include <cstdint>
#include <unordered_map>

namespace locograph {

class Experience {
 public:
  explicit Experience(const StanceSpace& space) : space_(space) {}

  /// A move of the end effector to a place; share: how far that is, as a part of its reach.
  void learn(const Footing& footing, int effector, int place, double share, bool found);
  /// Minus the logarithm of the share found of moves like this, where that is least.
  double unlikelihood(const Footing& footing, int effector, int place, double share) const;
  /// Of moves; what is known of lifts is kept.
  void forget_moves() { moves_.clear(); }

  /// The end effector could be lifted from this footing, or only the torques were in the way.
  void learn_lift(const Footing& footing, int effector, bool found);
  /// Minus the logarithm of the share of such lifts, its mean over the other contacts: where one of
  /// them stands says nothing alone, but where all are says what each would have to bear.
  double lift_unlikelihood(const Footing& footing, int effector) const;

 private:
  struct Count {
    double tried = 2.0, found = 1.8;  ///< before anything is known
    void add(bool success) {
      tried += 1.0;
      if (success) found += 1.0;
    }
    double share() const { return found / tried; }
  };

  template <class F>
  void each_likeness(const Footing& footing, int effector, int place, double share, F&& f) const;
  /// Of the place to each other contact, roughly.
  template <class F>
  void each_side(const Footing& footing, int effector, int place, F&& f) const;

  const StanceSpace& space_;
  std::unordered_map<std::uint64_t, Count> moves_, lifts_;  ///< by likeness
};

}  // namespace locograph
