#pragma once
/// How a benchmark program that prints one JSON object reads its arguments and fails.
///
///     int main(int argc, char** argv) {
///       CLI::App app("Grids by size", "scaling_benchmark");
///       int threads = 1;
///       app.add_option("--threads", threads)->check(CLI::PositiveNumber);
///       return locograph::run_benchmark(app, argc, argv, [&] { print(measure(threads)); });
///     }

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

namespace locograph {

/// The exit code: 0, or 2 when the arguments or what is run are no good, which standard error says.
template <class Run>
int run_benchmark(CLI::App& app, int argc, char** argv, Run run) {
  try {
    app.parse(argc, argv);
    run();
  } catch (const CLI::ParseError& usage) {
    return app.exit(usage) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    std::cerr << app.get_name() << ": " << error.what() << "\n";
    return 2;
  }
  return 0;
}

}  // namespace locograph
