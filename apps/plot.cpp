#include <locograph/apps/child_process.h>
#include <locograph/apps/plot.h>
#include <locograph/common/atomic_file.h>
#include <locograph/common/input_file.h>

namespace locograph {
namespace {

constexpr double kGnuplotTimeout_s = 60.0;

bool is_plain(unsigned char c) {
  return std::isalnum(c) != 0 ||
         std::string_view(" _.,:;+-*/()=%<>#|").find(static_cast<char>(c)) !=
             std::string_view::npos;
}

std::string plain(std::string text) {
  for (char& c : text) {
    if (!is_plain(static_cast<unsigned char>(c))) c = '?';
  }
  return text;
}

}  // namespace

PlotScript::PlotScript(int width, int height) {
  line("set encoding utf8");
  line("set terminal svg noenhanced size " + std::to_string(width) + "," + std::to_string(height) +
       " font 'DejaVu Sans,13' background '#ffffff'");
  line("set border 3 linewidth 0.8 linecolor '#606468'");
  line("set tics nomirror out scale 0.6 textcolor '#303438'");
  line("set grid linetype 1 linewidth 0.5 linecolor '#e4e6e8'");
  line("set key noenhanced textcolor '#303438' samplen 2");
  line("set style fill solid 0.85 noborder");
}

void PlotScript::data(const std::string& name, const std::string& rows) {
  // A row can never be the end mark: it holds numbers only.
  script_ += "$" + name + " << END_OF_DATA\n" + rows + "END_OF_DATA\n";
}

std::string PlotScript::label(const std::string& text) {
  std::string quoted = "'";
  quoted += plain(text);
  return quoted += "'";
}

void PlotScript::write(const std::filesystem::path& svg) const {
  const auto gnuplot = find_program({"gnuplot", "gnuplot-nox"});
  if (!gnuplot) throw Error("no gnuplot on the PATH", "the Debian package gnuplot-nox");
  const ScratchFolder folder;
  const std::filesystem::path script = folder.path() / "plot.gp", output = folder.path() / "p.svg";
  write_file_atomically(script, "set output '" + output.string() + "'\n" + script_);
  // -d: no settings of the user's.
  const ProcessResult result = run_process(*gnuplot, {"-d", script.string()}, kGnuplotTimeout_s);
  if (result.timed_out) throw Error("gnuplot did not finish", "a picture within a minute");
  if (result.exit_code != 0 || !std::filesystem::is_regular_file(output)) {
    throw Error("gnuplot failed: " + result.last_line(), "a picture");
  }
  const std::string text = read_file(output);
  if (text.find("</svg>") == std::string::npos) throw Error("gnuplot drew nothing", "an SVG");
  write_file_atomically(svg, text);
}

}  // namespace locograph
