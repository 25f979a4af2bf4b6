// Whether a graph finds balancing wrenches exactly when the certificate says that there are any, on
// random postures of COMAN+ and CENTAURO on random contacts.
//
//     balance_agreement [--cases N] [--seed N]
//
// Prints one JSON object, for each robot and each way a graph has surface contacts: how often the
// verdicts are the same, and every case where they are not and the margin is more than 1e-3 from
// the boundary; processor time of the certificate by the number of contacts.
#include <locograph/check/balance_certificate.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "balance_cases.h"
#include "command_line.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kBoundary = 1e-3;

double processor_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// One way a graph has surfaces.
class Comparison {
 public:
  Comparison(std::string name, SurfaceModel model) : name_(std::move(name)), model_(model) {}

  void add(const BalanceRobot& robot, const BalanceCase& posture, int number,
           const BalanceCertificate& certificate) {
    const double begin = processor_s();
    const double residual = graph_residual(robot, posture, model_);
    time_s_.push_back(processor_s() - begin);
    const bool graph = residual <= kGraphBalanced;
    if (graph == certificate.balanced) {
      ++same_;
    } else if (std::abs(certificate.margin) <= kBoundary) {
      ++near_boundary_;
    } else {
      ++(graph ? graph_alone_ : certificate_alone_);
      different_.push_back({{"case", number},
                            {"contacts", posture.contacts.size()},
                            {"margin", certificate.margin},
                            {"residual", residual},
                            {"limiting", certificate.limiting}});
    }
  }

  void print(Json& result) const {
    result["surfaces_as_" + name_] = {{"same", same_},
                                      {"different_within_1e-3", near_boundary_},
                                      {"graph_alone_balances", graph_alone_},
                                      {"certificate_alone_balances", certificate_alone_},
                                      {"graph_median_ms", 1e3 * median(time_s_)},
                                      {"different", different_}};
  }

 private:
  std::string name_;
  SurfaceModel model_;
  int same_ = 0, near_boundary_ = 0, graph_alone_ = 0, certificate_alone_ = 0;
  Json different_ = Json::array();
  std::vector<double> time_s_;
};

Json measure(const BalanceRobot& robot, int cases, unsigned long long seed) {
  std::mt19937_64 random(seed);
  Comparison rows("rows", SurfaceModel::kRows), corners("corners", SurfaceModel::kCorners);
  std::map<std::size_t, std::vector<double>> times;  // by the number of contacts
  std::map<std::string, int> limiting;
  int balanced = 0, surfaces = 0;
  for (int i = 0; i < cases; ++i) {
    const BalanceCase posture = draw_balance_case(robot, random);
    const double begin = processor_s();
    const BalanceCertificate certificate =
        certify_balance(robot.model(), posture.configuration, posture.contacts);
    times[posture.contacts.size()].push_back(processor_s() - begin);
    balanced += certificate.balanced;
    surfaces += std::any_of(posture.contacts.begin(), posture.contacts.end(), [](const Contact& c) {
      return c.effector.kind == ContactKind::kSurface;
    });
    ++limiting[certificate.limiting.substr(0, certificate.limiting.find(" of "))];
    rows.add(robot, posture, i, certificate);
    const BalanceCase unlimited = without_surface_limits(robot, posture);
    corners.add(robot, unlimited, i,
                certify_balance(robot.model(), unlimited.configuration, unlimited.contacts));
  }
  Json result = {
      {"robot", robot.name}, {"cases", cases}, {"with_surfaces", surfaces}, {"balanced", balanced}};
  for (const auto& [words, count] : limiting) result["limited_by"][words] = count;
  rows.print(result);
  corners.print(result);
  for (const auto& [contacts, seconds] : times) {
    result["certificate_ms"].push_back(
        {{"contacts", contacts},
         {"cases", seconds.size()},
         {"median", 1e3 * median(seconds)},
         {"max", 1e3 * *std::max_element(seconds.begin(), seconds.end())}});
  }
  return result;
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  unsigned long long seed = 1;
  int cases = 1000;
  locograph::OptionParser app("Balance by a graph and by the certificate", "balance_agreement");
  app.add_option("--seed", seed, "Of the postures");
  app.add_option("--cases", cases, "For each robot").positive();
  return locograph::run_benchmark(app, argc, argv, [&] {
    locograph::Json robots = locograph::Json::array();
    for (const char* name : {"coman_plus", "centauro"}) {
      robots.push_back(locograph::measure(locograph::balance_robot(name), cases, seed));
    }
    std::cout << locograph::Json{{"seed", seed}, {"robots", robots}}.dump(2) << '\n';
  });
}
