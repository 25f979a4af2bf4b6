// A program that wants the judge and nothing else: links locograph::check alone.
#include <locograph/check/judge.h>

#include <iostream>

int main(int argc, char** argv) {
  using namespace locograph;
  if (argc != 3) return 2;
  const auto robot = std::make_shared<const Robot>(Robot::load(argv[1], argv[2]));
  World world;
  world.surfaces = {ground()};
  const CheckReport report =
      Judge(robot, world).check(Motion{{0.0}, {robot->neutral_configuration()}, {}, {}});
  std::cout << violation_text(report.constraint("stance")) << '\n';
  return report.feasible ? 1 : 0;  // nobody said where it stands
}
