#pragma once
/// Diagrams as SVG, drawn by gnuplot.
///
///     PlotScript plot;
///     plot.data("cost", "0 12.5\n1 3.25\n");
///     plot.line("set logscale y");
///     plot.line("plot $cost with lines title 'chi2'");
///     plot.write("convergence.svg");
///
/// Commands go to gnuplot through a file, never through a shell. Whatever comes from a user's file
/// must enter through data(), label() or a number: label() makes it harmless text. (Gnuplot runs
/// what stands in backquotes, and expands @names.)

#include <filesystem>
#include <string>
#include <vector>

namespace locograph {

class PlotScript {
 public:
  /// width, height of the picture, px.
  explicit PlotScript(int width = 900, int height = 520);

  void line(const std::string& command) { script_ += command + '\n'; }
  /// `$name` holds the rows from now on: numbers separated by blanks.
  void data(const std::string& name, const std::string& rows);

  /// 'text' with its quotes; what is not a plain character becomes '?'.
  static std::string label(const std::string& text);

  /// Runs gnuplot; the file is written whole or not at all. Throws Error when gnuplot is missing
  /// (with the name of the Debian package) or refuses the script.
  void write(const std::filesystem::path& svg) const;

 private:
  std::string script_;
};

/// The diagram of a result: JSON of optimize, refine or check, a plan (.g2o) or a table (.csv).
/// Throws Error when the file is none of these. plugins: for a plan, as graph_types().
PlotScript plot_result(const std::filesystem::path& result,
                       const std::vector<std::string>& plugins = {});
PlotScript plot_plan(const std::filesystem::path& plan,
                     const std::vector<std::string>& plugins = {});
PlotScript plot_table(const std::filesystem::path& table);

}  // namespace locograph
