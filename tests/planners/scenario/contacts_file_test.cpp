#include <locograph/planners/scenario/contacts_file.h>

#include "common/temporary_folder.h"
#include "planners/mistakes.h"

namespace locograph::test {
namespace {

const Robot& coman_plus() {
  static const std::string file = LOCOGRAPH_SOURCE_DIR "/robots/models/coman_plus/coman_plus";
  static const Robot robot = Robot::load(file + ".urdf", file + ".srdf");
  return robot;
}

const char kGood[] =
    "<contacts version=\"1\" name=\"all kinds\">\n"
    "  <contact link=\"l_sole\" kind=\"surface\" position=\"0 0.1 0\" normal=\"0 0 2\""
    " forward=\"1 0 0\" half_x=\"0.08\" half_y=\"0.04\" mu=\"0.6\" max_force=\"900\"/>\n"
    "  <contact link=\"TCP_L\" kind=\"point\" point=\"0 0 0.01\" position=\"0.5 0.3 1\""
    " normal=\"-1 0 0\" mu=\"0.5\" max_force=\"200\" load=\"no\"/>\n"
    "  <contact link=\"TCP_R\" kind=\"rung\" position=\"0.5 -0.3 1\" normal=\"0 0 1\""
    " forward=\"1 0 0\" link_normal=\"0 1 0\" link_forward=\"0 0 1\" max_force=\"300\""
    " max_moment=\"5\"/>\n"
    "</contacts>\n";

TEST(ContactsFile, ReadsEveryKind) {
  const TemporaryFolder folder;
  const std::vector<Contact> contacts =
      load_contacts(folder.write("contacts.xml", kGood), coman_plus()).contacts;
  ASSERT_EQ(contacts.size(), 3U);
  EXPECT_EQ(contacts[0].effector.kind, ContactKind::kSurface);
  EXPECT_EQ(contacts[0].effector.link, "l_sole");
  EXPECT_EQ(contacts[0].effector.half_x_m, 0.08);
  EXPECT_EQ(contacts[0].effector.half_y_m, 0.04);
  EXPECT_EQ(contacts[0].effector.friction, 0.6);
  EXPECT_EQ(contacts[0].effector.max_force_N, 900.0);
  EXPECT_EQ(contacts[0].effector.normal, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(contacts[0].position, Eigen::Vector3d(0.0, 0.1, 0.0));
  EXPECT_EQ(contacts[0].normal, Eigen::Vector3d(0.0, 0.0, 2.0));
  EXPECT_EQ(contacts[0].forward, Eigen::Vector3d::UnitX());
  EXPECT_TRUE(contacts[0].bears_load);
  EXPECT_EQ(contacts[1].effector.kind, ContactKind::kPoint);
  EXPECT_EQ(contacts[1].effector.point, Eigen::Vector3d(0.0, 0.0, 0.01));
  EXPECT_FALSE(contacts[1].forward);
  EXPECT_FALSE(contacts[1].bears_load);
  EXPECT_EQ(contacts[2].effector.kind, ContactKind::kGrasp);
  EXPECT_EQ(contacts[2].effector.normal, Eigen::Vector3d::UnitY());
  EXPECT_EQ(contacts[2].effector.forward, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(contacts[2].effector.max_moment_Nm, 5.0);
}

TEST(ContactsFile, ReadsBallsWheelsAndSeveralContactsOfOneLink) {
  const std::string stem = LOCOGRAPH_SOURCE_DIR "/robots/models/centauro/centauro";
  const Robot centauro = Robot::load(stem + ".urdf", stem + ".srdf");
  const TemporaryFolder folder;
  const std::string rest = " normal=\"0 0 1\" mu=\"0.6\" max_force=\"900\"";
  const std::vector<Contact> contacts =
      load_contacts(folder.write("contacts.xml",
                                 "<contacts version=\"1\">"
                                 "<contact link=\"ball1_tip\" kind=\"point\" radius=\"0.03\" "
                                 "position=\"1 0 0\"" +
                                     rest +
                                     "/>"
                                     "<contact link=\"ball1_tip\" kind=\"point\" point=\"0.1 0 0\" "
                                     "position=\"1 0.1 0.03\"" +
                                     rest +
                                     "/>"
                                     "<contact link=\"wheel_1\" kind=\"wheel\" radius=\"0.078\" "
                                     "position=\"0 0 0\"" +
                                     rest + "/></contacts>"),
                    centauro)
          .contacts;
  ASSERT_EQ(contacts.size(), 3u);
  EXPECT_EQ(contacts[0].effector.radius_m, 0.03);
  EXPECT_EQ(contacts[0].name(), "ball1_tip");
  EXPECT_EQ(contacts[1].effector.radius_m, 0.0);
  EXPECT_EQ(contacts[1].name(), "ball1_tip_2");
  EXPECT_EQ(contacts[2].effector.kind, ContactKind::kWheel);
  EXPECT_EQ(contacts[2].effector.radius_m, 0.078);
}

TEST(ContactsFile, TheExamplesThatComeAlongLoad) {
  EXPECT_EQ(
      load_contacts(LOCOGRAPH_SOURCE_DIR "/examples/posture/coman_plus_wall.xml", coman_plus())
          .contacts.size(),
      3U);
}

TEST(ContactsFile, RefusesDirectionsThatAreNoneWithoutTheRobot) {
  const TemporaryFolder folder;
  const auto read = [](const auto& path) { load_contacts(path); };
  for (const Mistake& mistake :
       {Mistake{"", "normal=\"-1 0 0\"", "normal=\"0 0 0\"", 3, "normal of length zero"},
        Mistake{"", "\"0 0 2\"", "\"0 nan 2\"", 2, "3 finite numbers"},
        Mistake{"", "forward=\"1 0 0\"", "forward=\"0 0 1\"", 2, "along its normal"},
        Mistake{"", "link_normal=\"0 1 0\"", "link_normal=\"0 0 0\"", 4, "normal of length zero"},
        Mistake{"", " forward=\"1 0 0\" link_normal", " link_normal", 4, "rung without forward"}}) {
    expect_refused(folder.write("contacts.xml", with(kGood, mistake.find, mistake.replace)),
                   mistake, read);
  }
  EXPECT_EQ(load_contacts(folder.write("contacts.xml", kGood)).contacts.size(), 3U);
}

class ContactsFileMistakes : public testing::TestWithParam<Mistake> {};

TEST_P(ContactsFileMistakes, AreRefusedWithTheirLine) {
  const TemporaryFolder folder;
  const auto file = folder.write("contacts.xml", with(kGood, GetParam().find, GetParam().replace));
  expect_refused(file, GetParam(), [](const auto& path) { load_contacts(path, coman_plus()); });
}

const Mistake kMistakes[] = {
    {"AnotherVersion", "version=\"1\"", "version=\"2\"", 1, "version '2'"},
    {"AnotherRoot", "<contacts version=\"1\" name=\"all kinds\">\n",
     "<contacts version=\"1\">\n<a/>", 2, "unknown element <a>"},
    {"AnUnknownLink", "l_sole", "l_soul", 2, "l_sole"},
    {"AnUnknownKind", "kind=\"point\"", "kind=\"hook\"", 3, "unknown kind of contact 'hook'"},
    {"NoKind", " kind=\"point\"", "", 3, "without kind"},
    {"AMisspeltAttribute", "half_x", "halfx", 2, "unknown attribute 'halfx'"},
    {"AnAttributeOfAnotherKind", "max_moment", "mu=\"0.5\" max_moment", 4,
     "unknown attribute 'mu'"},
    {"NoPosition", " position=\"0 0.1 0\"", "", 2, "without position"},
    {"NoNormal", " normal=\"0 0 2\"", "", 2, "without normal"},
    {"APositionOfTwoNumbers", "\"0 0.1 0\"", "\"0 0.1\"", 2, "3 finite numbers"},
    {"APositionThatIsNotFinite", "\"0 0.1 0\"", "\"0 nan 0\"", 2, "3 finite numbers"},
    {"ANormalOfLengthZero", "\"0 0 2\"", "\"0 0 0\"", 2, "normal of length zero"},
    {"AForwardAlongTheNormal", "forward=\"1 0 0\"", "forward=\"0 0 1\"", 2, "along its normal"},
    {"ANormalOfTheLinkAlongItsForward", "link_normal=\"0 1 0\"", "link_normal=\"0 0 1\"", 4,
     "along its normal"},
    {"ARungWithoutForward", " forward=\"1 0 0\" link_normal", " link_normal", 4,
     "rung without forward"},
    {"NegativeFriction", "mu=\"0.6\"", "mu=\"-0.6\"", 2, "mu is -0.6"},
    {"AHalfSizeOfZero", "half_y=\"0.04\"", "half_y=\"0\"", 2, "half_y is 0"},
    {"APlaceBeyondAllDistances", "\"0 0.1 0\"", "\"0 1e16 0\"", 2,
     "position=\"0 1e16 0\", expected numbers up to 1e+06"},
    {"APlaceOnTheLinkBeyondAllDistances", "\"0 0 0.01\"", "\"0 0 -1e17\"", 3,
     "point=\"0 0 -1e17\""},
    {"ASizeBeyondAllSizes", "half_x=\"0.08\"", "half_x=\"1e16\"", 2,
     "half_x is 1e+16, expected a number from 1e-06 to 1e+06"},
    {"AForceBeyondAllForces", "max_force=\"200\"", "max_force=\"1e300\"", 3,
     "max_force is 1e+300, expected a number > 0 to 1e+09"},
    {"AMomentBeyondAllMoments", "max_moment=\"5\"", "max_moment=\"1e300\"", 4,
     "max_moment is 1e+300"},
    {"FrictionBeyondAllFriction", "mu=\"0.6\"", "mu=\"1e300\"", 2, "mu is 1e+300"},
    {"AForceLimitThatIsNone", "max_force=\"200\"", "max_force=\"inf\"", 3, "1 finite number"},
    {"ANegativeMoment", "max_moment=\"5\"", "max_moment=\"-5\"", 4, "max_moment is -5"},
    {"ASurfaceWithARadius", "half_x=", "radius=\"0.1\" half_x=", 2, "unknown attribute 'radius'"},
    {"ABallWithoutARadius", "kind=\"point\"", "kind=\"point\" radius=\"0\"", 3, "radius is 0"},
    {"AWheelThatDoesNotTurn", "kind=\"point\" point=\"0 0 0.01\"", "kind=\"wheel\" radius=\"0.1\"",
     3, "wheel that no joint turns"},
    {"AnotherLoad", "load=\"no\"", "load=\"maybe\"", 3, "load is 'maybe'"},
    {"OneLinkAtTwoPlaces", "TCP_R", "TCP_L", 4, "contradict each other"},
};
INSTANTIATE_TEST_SUITE_P(All, ContactsFileMistakes, testing::ValuesIn(kMistakes), mistake_name);

TEST(ContactsFile, RefusesNoneAndNoneThatBearsLoad) {
  const TemporaryFolder folder;
  EXPECT_THROW(load_contacts(folder.write("none.xml", "<contacts version=\"1\"/>"), coman_plus()),
               Error);
  EXPECT_THROW(load_contacts(folder.file("missing.xml"), coman_plus()), Error);
  EXPECT_THROW(
      load_contacts(folder.write("idle.xml",
                                 "<contacts version=\"1\">\n<contact link=\"TCP_L\" kind=\"point\" "
                                 "position=\"0 0 1\" normal=\"1 0 0\" mu=\"1\" max_force=\"1\" "
                                 "load=\"no\"/>\n</contacts>"),
                    coman_plus()),
      Error);
}

TEST(ContactsFile, HoldsNoMoreContactsThanARobotHasUseFor) {
  std::string text = "<contacts version=\"1\">\n";
  for (int i = 0; i < 101; ++i) {
    text += "<contact link=\"l_sole\" kind=\"point\" point=\"0 " + std::to_string(i) +
            " 0\" position=\"0 " + std::to_string(i) +
            " 0\" normal=\"0 0 1\" mu=\"0.6\" max_force=\"9\"/>\n";
  }
  const TemporaryFolder folder;
  try {
    load_contacts(folder.write("many.xml", text + "</contacts>"), coman_plus());
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.line(), 102);
    EXPECT_NE(std::string(error.what()).find("more than 100"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace locograph::test
