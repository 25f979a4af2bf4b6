#pragma once
/// How a benchmark program that prints one JSON object reads its arguments and fails.
///
///     int main(int argc, char** argv) {
///       locograph::OptionParser app("Grids by size", "scaling_benchmark");
///       int threads = 1;
///       app.add_option("--threads", threads).positive();
///       return locograph::run_benchmark(app, argc, argv, [&] { print(measure(threads)); });
///     }

#include <locograph/apps/option_parser.h>

#include <exception>
#include <iostream>

namespace locograph {

/// The exit code: 0, or 2 when the arguments or what is run are no good, which standard error says.
template <class Run>
int run_benchmark(OptionParser& app, int argc, char** argv, Run run) {
  try {
    if (app.parse(argc, argv)) run();
  } catch (const std::exception& error) {
    std::cerr << app.name() << ": " << error.what() << "\n";
    return 2;
  }
  return 0;
}

}  // namespace locograph
