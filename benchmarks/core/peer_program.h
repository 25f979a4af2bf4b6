#pragma once
/// Another optimiser's program, run on the same file: for figures side by side in one run.
///
/// Two kinds: `g2o`, the command of that name, whose verbose output is read; and adapters, programs
/// of ours linked with a peer's library (benchmarks/peers/), called as `PROGRAM FILE.g2o` and
/// printing lines `SECONDS CHI2`, one for each accepted step, in the peer's own error convention,
/// the clock starting when the graph is loaded.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace locograph {

struct PeerProgram {
  std::string name;     ///< for the report
  std::string program;  ///< path
  std::string solver;   ///< of g2o: its -solver; empty for an adapter
};

/// Pairs of (seconds, chi2), in order; empty when the program fails or cannot read the file.
std::vector<std::pair<double, double>> run_peer(const PeerProgram& peer,
                                                const std::filesystem::path& file);

}  // namespace locograph
