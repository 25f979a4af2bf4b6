#include "peer_program.h"

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <sstream>

namespace locograph {
namespace {

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  char buffer[4096];
  while (pipe && std::fgets(buffer, sizeof buffer, pipe.get()) != nullptr) text += buffer;
  return text;
}

/// The number after `key` in a line, or a negative one when the key is not there.
double number_after(const std::string& line, const std::string& key) {
  const std::size_t at = line.find(key);
  return at == std::string::npos ? -1.0 : std::strtod(line.c_str() + at + key.size(), nullptr);
}

}  // namespace

std::vector<std::pair<double, double>> run_peer(const PeerProgram& peer,
                                                const std::filesystem::path& file) {
  std::vector<std::pair<double, double>> history;
  if (peer.solver.empty()) {
    std::istringstream lines(output_of(quoted(peer.program) + " " + quoted(file.string())));
    for (double seconds, chi2; lines >> seconds >> chi2;) history.emplace_back(seconds, chi2);
    return history;
  }
  std::istringstream lines(output_of(quoted(peer.program) + " -v -i 100 -gain 1e-7 -solver " +
                                     quoted(peer.solver) + " " + quoted(file.string()) + " 2>&1"));
  for (std::string line; std::getline(lines, line);) {
    const double seconds = number_after(line, "cumTime= "), chi2 = number_after(line, "chi2= ");
    if (line.starts_with("iteration=") && seconds >= 0.0) history.emplace_back(seconds, chi2);
  }
  return history;
}

}  // namespace locograph
