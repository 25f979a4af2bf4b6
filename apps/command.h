#pragma once
/// How a command joins `locograph`: one function that adds it to the command line.
///
///     Command add_greet(OptionParser& app) {
///       auto name = std::make_shared<std::string>();
///       OptionParser parser = app.add_subcommand("greet", "Say hello");
///       parser.add_option("NAME", *name, "Whom to greet").required();
///       return {parser, [name] { return std::cout << "Hello " << *name << '\n', kDone; }};
///     }
///
/// Each command is a file pair NAME_command.{h,cpp}; main.cpp lists them. Bad input is thrown as
/// locograph::Error: main() turns it into one line and exit code 2.

#include <locograph/apps/option_parser.h>

#include <functional>

namespace locograph {

enum ExitCode {
  kDone = 0,
  kNo = 1,        ///< the job ran, the answer is no: the output says why
  kBadInput = 2,  ///< wrong usage or bad input: one line on stderr
};

struct Command {
  OptionParser parser;
  std::function<ExitCode()> run;
};

}  // namespace locograph
