#pragma once
/// A liar's corpus: single corruptions of motions that the judge accepts, each of which breaks a
/// constraint by one and a half times its tolerance, and has to be refused by it.
///
///     Honest honest{.name = "standing", .robot = robot, .world = world, .motion = motion};
///     std::mt19937_64 random(7);
///     for (const Corruption& corruption : corruptions())
///       if (const std::optional<Lie> lie = corruption.make(honest, random))
///         if (accepted(honest, *lie)) std::cerr << corruption.name << " was believed\n";
///
/// A corruption that a motion gives no hold to (no wheel to block, no step to run through too
/// fast) makes no lie of it. Everything is drawn from the generator that is passed in.

#include <locograph/check/judge.h>

#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace locograph::test {

/// A motion, or a single configuration, that the judge accepts in its world.
struct Honest {
  std::string name;
  std::shared_ptr<const Robot> robot;
  World world;
  Motion motion;
  CheckOptions options;  ///< with what is known of the end effectors
};

struct Lie {
  Motion motion;
  std::optional<World> world;  ///< if it is another one
  CheckOptions options;
  std::vector<std::string> breaks;  ///< one of these must be violated
};

struct Corruption {
  std::string name;
  std::optional<Lie> (*make)(const Honest& honest, std::mt19937_64& random);
};

/// In a fixed order.
const std::vector<Corruption>& corruptions();

struct Verdict {
  bool refused = false;  ///< the motion is not feasible
  bool by_name = false;  ///< because of what the lie breaks
  std::string violated;  ///< what was violated, for a message
};

/// `judge`: of the honest world; a lie about the world gets a judge of its own.
Verdict judge_lie(const Honest& honest, const Judge& judge, const Lie& lie);

}  // namespace locograph::test
