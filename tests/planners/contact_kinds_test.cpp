// What a kind of contact that a program has added is to the planners: its attributes, its places
// and what it bears; and that the judge does not let it pass.
#include <gtest/gtest.h>
#include <locograph/check/balance_certificate.h>
#include <locograph/planners/balance/balance_region.h>
#include <locograph/planners/scenario/contact_place.h>
#include <locograph/planners/scenario/contacts_file.h>

#include "common/temporary_folder.h"
#include "planners/mistakes.h"
#include "robots/blade_contact.h"

namespace locograph::test {
namespace {

constexpr const char* kSkate =
    "<contacts version=\"1\">\n"
    "<contact link=\"block\" kind=\"blade\" half_y=\"0.1\" mu=\"0.5\" max_force=\"1000\""
    " link_normal=\"0 0 1\" position=\"0.3 0.2 0\" normal=\"0 0 1\" forward=\"1 0 0\"/>\n"
    "</contacts>\n";

class AddedKindInPlanners : public testing::Test {
 protected:
  AddedKindInPlanners() { blade(); }

  Stance load(std::string text, const std::string& from = "", const std::string& to = "") const {
    if (!from.empty()) text.replace(text.find(from), from.size(), to);
    return load_contacts(folder.write("contacts.xml", text));
  }
  TemporaryFolder folder;
};

TEST_F(AddedKindInPlanners, IsReadFromAContactsFile) {
  const Contact skate = load(kSkate).contacts.at(0);
  EXPECT_EQ(skate.effector.kind, blade());
  EXPECT_EQ(skate.effector.half_y_m, 0.1);
  EXPECT_EQ(skate.effector.friction, 0.5);
  EXPECT_THROW(load(kSkate, "half_y", "half_x"), Error);
  EXPECT_THROW(load(kSkate, " half_y=\"0.1\"", ""), Error);
  EXPECT_THROW(load(kSkate, " mu=\"0.5\"", ""), Error);
}

TEST_F(AddedKindInPlanners, LiesOnSurfacesAndOnNoBar) {
  Contact skate = load(kSkate).contacts.at(0);
  World world;
  world.surfaces.push_back({.name = "floor", .half_x_m = 1.0, .half_y_m = 1.0});
  world.bars.push_back({.name = "rail", .from = {0.3, -1.0, 0.0}, .to = {0.3, 1.0, 0.0}});
  EXPECT_TRUE(lies_on(world.surfaces[0], skate));
  EXPECT_FALSE(lies_on(world.bars[0], skate));
  skate.position.x() = 1.1;
  EXPECT_FALSE(lies_on(world.surfaces[0], skate)) << "it has no area that reaches in";
}

TEST_F(AddedKindInPlanners, BearsBetweenTheEndsOfTwo) {
  const Contact skate = load(kSkate).contacts.at(0);
  std::vector<BearingContact> skates(2, {skate});
  skates[1].contact.position.x() -= 0.4;
  // Forces at the four ends, each on its part of 0.9.
  const BalanceRegion region = balance_region(10.0, skates, 0.1);
  EXPECT_NEAR(region.width_m, 2.0 * 0.09, 1e-5);
  EXPECT_NEAR(region.depth_m({0.1, 0.2}), 0.09, 1e-5);
  EXPECT_NEAR(region.depth_m({0.3, 0.2}), 0.0, 1e-5);
}

TEST_F(AddedKindInPlanners, IsRefusedByTheJudge) {
  const Robot robot = Robot::load(folder.write(
      "block.urdf",
      "<robot name='block'><link name='block'><inertial><mass value='10'/><inertia ixx='1' "
      "ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link></robot>"));
  try {
    certify_balance(robot, robot.neutral_configuration(), load(kSkate).contacts);
    FAIL() << "was judged";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("no rules for"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace locograph::test
