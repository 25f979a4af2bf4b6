// The liar's corpus on plans and postures that the planners make: how many lies are believed.
//
//     liar_campaign [--lies N] [--seed N]
//
// Originals are drives of CENTAURO, straight and along arcs, and postures of four robots on random
// contacts (benchmarks/planners/random_contact_sets.h). Each is judged first, and counted where it
// is refused although its planner calls it good. Then corruptions (benchmarks/check/corruptions.h)
// are drawn until N lies have been told. Prints one JSON object; exits with 1 if a lie was
// believed, or an original refused.
#include <locograph/common/data_folder.h>
#include <locograph/common/deadline.h>
#include <locograph/planners/offline/drive/wheeled_drive.h>
#include <locograph/planners/plan/judging.h>
#include <locograph/planners/plan/plan.h>

#include <map>
#include <nlohmann/json.hpp>

#include "check/corruptions.h"
#include "command_line.h"
#include "planners/random_contact_sets.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;
using test::Honest;

double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * 0x1.0p-53 * static_cast<double>(random() >> 11);
}

std::filesystem::path sources() { return LOCOGRAPH_SOURCE_DIR; }

Honest drive(std::mt19937_64& random) {
  Scenario scenario = load_scenario("centauro_drive", data_folder());
  scenario.drive->distance_m = uniform(random, 0.3, 1.5);
  scenario.drive->curvature_1_m = random() % 2 == 0 ? 0.0 : uniform(random, -0.3, 0.3);
  scenario.drive->speed_m_s = uniform(random, 0.05, 0.2);
  scenario.drive->configurations = 4 + static_cast<int>(random() % 12);
  scenario.limits.base_linear_m_s = 0.5;
  const Task task = task_of(scenario);
  Honest honest{.name = "drive",
                .robot = task.robot->robot,
                .world = task.world->world(),
                .motion = plan_wheeled_drive(task).motion,
                .options = {}};
  honest.options.known = task.end_effectors();
  honest.options.base_linear_m_s = task.check.base_linear_m_s;
  return honest;
}

class Postures {
 public:
  Postures(const std::string& name, std::uint64_t seed)
      : robot_(test::posture_robot(name, sources(), LOCOGRAPH_SHARED_DATA)),
        solver_(robot_.robot),
        sets_(robot_, seed) {}

  /// The next one that is found.
  Honest next() {
    for (;;) {
      const test::ContactSet set = sets_.draw();
      const PostureProblem problem{set.stance, placed_at(robot_.model(), robot_.home, set.stance)};
      const PostureResult found = solver_.solve(problem);
      if (!found.success()) continue;
      Honest honest{.name = robot_.name,
                    .robot = robot_.robot->robot,
                    .world = posture_world(),
                    .motion = {},
                    .options = posture_check()};
      honest.motion.time_s = {0.0};
      honest.motion.configurations = {found.configuration};
      honest.motion.stances = {problem.stance};
      honest.motion.stance_from = {0};
      for (Contact& contact : honest.motion.stances.front().contacts) {
        contact.effector.name = contact.effector.link;
        honest.options.known.push_back(contact.effector);
        honest.options.places.push_back(contact);
      }
      return honest;
    }
  }

 private:
  test::PostureRobot robot_;
  PostureSolver solver_;
  test::ContactSets sets_;
};

struct Count {
  int lies = 0, believed = 0, by_another_name = 0;
};

bool campaign(int wanted, std::uint64_t seed) {
  const Stopwatch watch;
  std::mt19937_64 random(seed);
  std::vector<std::unique_ptr<Postures>> postures;
  for (const char* robot : {"coman_plus", "centauro", "go2", "anymal"})
    postures.push_back(std::make_unique<Postures>(robot, seed));
  std::map<std::string, Count> counts;
  Count all;
  int originals = 0, refused_originals = 0;
  Json examples = Json::array();
  while (all.lies < wanted) {
    const std::size_t kind = static_cast<std::size_t>(originals) % (postures.size() + 1);
    const Honest honest = kind == 0 ? drive(random) : postures[kind - 1]->next();
    ++originals;
    const Judge judge(honest.robot, honest.world);
    const CheckReport report = judge.check(honest.motion, honest.options);
    if (!report.feasible) {
      ++refused_originals;
      examples.push_back("original refused: " + honest.name + ": " +
                         violation_text(report.worst()));
      continue;
    }
    for (const test::Corruption& corruption : test::corruptions()) {
      const std::optional<test::Lie> lie = corruption.make(honest, random);
      if (!lie || all.lies >= wanted) continue;
      const test::Verdict verdict = test::judge_lie(honest, judge, *lie);
      for (Count* count : {&counts[corruption.name], &all}) {
        ++count->lies;
        count->believed += verdict.refused ? 0 : 1;
        count->by_another_name += verdict.refused && !verdict.by_name ? 1 : 0;
      }
      if (!verdict.by_name && examples.size() < 20) {
        examples.push_back(honest.name + ", " + corruption.name + ": " +
                           (verdict.refused ? "refused for " + verdict.violated : "believed"));
      }
    }
  }
  Json by_corruption = Json::object();
  for (const auto& [name, count] : counts) {
    by_corruption[name] = {{"lies", count.lies},
                           {"believed", count.believed},
                           {"refused_by_another_name", count.by_another_name}};
  }
  std::cout << Json{{"seed", seed},
                    {"originals", originals},
                    {"originals_refused", refused_originals},
                    {"lies", all.lies},
                    {"believed", all.believed},
                    {"refused_by_another_name", all.by_another_name},
                    {"corruptions", by_corruption},
                    {"examples", examples},
                    {"seconds", watch.seconds()}}
                   .dump(2)
            << '\n';
  return all.believed == 0 && refused_originals == 0;
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  locograph::OptionParser app("Lies that the judge is told", "liar_campaign");
  int lies = 10000;
  std::uint64_t seed = 1;
  app.add_option("--lies", lies).positive();
  app.add_option("--seed", seed);
  return locograph::run_benchmark(app, argc, argv, [&] {
    if (!locograph::campaign(lies, seed)) throw locograph::Error("a lie was believed", "none");
  });
}
