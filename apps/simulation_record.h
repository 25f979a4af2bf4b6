#pragma once
/// What `simulate` writes of a run: the record as a graph, and as a table.
///
///     const SimulationResult result = simulate(robot, effectors, world, motion, options);
///     const Record record = record_of_run(file.graph, file.plan, effectors, result.samples);
///     write_graph(record_graph(file.graph, file.plan, record), "result.g2o");

#include <locograph/execution/simulation.h>
#include <locograph/planners/plan/record.h>

#include <span>
#include <string>

namespace locograph {

/// Up to the first sample with a number that no file has, as when the engine gives up. effectors:
/// those of the run.
Record record_of_run(const Graph& graph, const Plan& plan, std::span<const EndEffector> effectors,
                     std::span<const SimulationSample> samples);

/// All of it: times, configuration, where the plan has it, torques, and forces in the world, also
/// at end effectors that nothing should touch.
std::string samples_csv(const Robot& robot, std::span<const EndEffector> effectors,
                        std::span<const SimulationSample> samples);

}  // namespace locograph
