#pragma once
/// How far from falling a motion is: by what friction, contact areas and torques may shrink, how
/// hard it may be pushed, and what may be loaded on it, until some moment of it holds no longer.
///
///     CheckOptions options;
///     options.robustness = true;
///     const CheckReport report = judge.check(motion, options);
///     if (report.robustness->least.push_N < 20.0) std::cerr << "a nudge tips it over\n";
///
/// A moment holds where wrenches balance it, within friction, areas, forces and, where they are
/// enforced, torques, by the linear programme of balance_certificate.h. Each of these is changed
/// alone:
///
///   friction   of all contacts, times 1 - x
///   area       both half sizes of surface contacts, times 1 - x
///   torque     all efforts, times 1 - x
///   push       a horizontal force at the centre of mass, the least of 16 directions; at most the
///              weight
///   mass       at the origin of the root link, accelerated with it, as a share of the robot's; at
///              most 1
///
/// Moments are those of balance_along.h: each vertex on both sides with the inertia of the curve,
/// every 0.05 s of longer steps, and at rest where a whole motion begins and ends; of a plan of
/// stances the transitions on both stances. For each stance that is held in a row a moment is
/// tested at the least change so far, and what that is there is sought by bisection only if it
/// fails: to 1/1024 of the most that is looked for. A moment near one that was found to hold mostly
/// holds by wrenches near those (nearby_balance.h), without a programme.
///
/// Deterministic, with any number of threads. Nothing of this counts in CheckReport::feasible.

#include <locograph/check/check_context.h>
#include <locograph/common/thread_pool.h>

#include <vector>

namespace locograph {

/// The motion's, where it has times and stances and a base that is free; of a single configuration
/// its own. Nothing where no moment can be looked at.
std::optional<RobustnessReport> robustness_of(CheckContext& context, ThreadPool& threads);

}  // namespace locograph
