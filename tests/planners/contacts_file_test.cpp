#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/planners/posture/contacts_file.h>

#include <string>

#include "common/temporary_folder.h"

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
  const std::vector<PlacedContact> contacts =
      load_contacts(folder.write("contacts.xml", kGood), coman_plus());
  ASSERT_EQ(contacts.size(), 3U);
  EXPECT_EQ(contacts[0].contact.kind, WrenchKind::kSurface);
  EXPECT_EQ(contacts[0].contact.link, "l_sole");
  EXPECT_EQ(contacts[0].contact.half_x_m, 0.08);
  EXPECT_EQ(contacts[0].contact.half_y_m, 0.04);
  EXPECT_EQ(contacts[0].contact.mu, 0.6);
  EXPECT_EQ(contacts[0].contact.max_force_N, 900.0);
  EXPECT_EQ(contacts[0].contact.normal, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(contacts[0].position, Eigen::Vector3d(0.0, 0.1, 0.0));
  EXPECT_EQ(contacts[0].normal, Eigen::Vector3d(0.0, 0.0, 2.0));
  EXPECT_EQ(contacts[0].forward, Eigen::Vector3d::UnitX());
  EXPECT_TRUE(contacts[0].bears_load);
  EXPECT_EQ(contacts[1].contact.kind, WrenchKind::kPoint);
  EXPECT_EQ(contacts[1].contact.point, Eigen::Vector3d(0.0, 0.0, 0.01));
  EXPECT_FALSE(contacts[1].forward);
  EXPECT_FALSE(contacts[1].bears_load);
  EXPECT_EQ(contacts[2].contact.kind, WrenchKind::kRung);
  EXPECT_EQ(contacts[2].contact.normal, Eigen::Vector3d::UnitY());
  EXPECT_EQ(contacts[2].contact.forward, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(contacts[2].contact.max_moment_Nm, 5.0);
}

TEST(ContactsFile, TheExamplesThatComeAlongLoad) {
  EXPECT_EQ(
      load_contacts(LOCOGRAPH_SOURCE_DIR "/examples/posture/coman_plus_wall.xml", coman_plus())
          .size(),
      3U);
}

struct Mistake {
  const char* name;
  const char* find;     ///< in kGood
  const char* replace;  ///< by this
  int line;
  const char* words;
};

class ContactsFileMistakes : public testing::TestWithParam<Mistake> {};

TEST_P(ContactsFileMistakes, AreRefusedWithTheirLine) {
  const Mistake& mistake = GetParam();
  std::string text = kGood;
  const std::size_t at = text.find(mistake.find);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, std::string(mistake.find).size(), mistake.replace);
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.write("contacts.xml", text);
  try {
    load_contacts(file, coman_plus());
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), file.string());
    EXPECT_EQ(error.line(), mistake.line) << error.what();
    EXPECT_NE(std::string(error.what()).find(mistake.words), std::string::npos) << error.what();
  }
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
    {"AForceLimitThatIsNone", "max_force=\"200\"", "max_force=\"inf\"", 3, "1 finite number"},
    {"ANegativeMoment", "max_moment=\"5\"", "max_moment=\"-5\"", 4, "max_moment is -5"},
    {"AnotherLoad", "load=\"no\"", "load=\"maybe\"", 3, "load is 'maybe'"},
    {"OneLinkAtTwoPlaces", "TCP_R", "TCP_L", 4, "contradict each other"},
};
INSTANTIATE_TEST_SUITE_P(All, ContactsFileMistakes, testing::ValuesIn(kMistakes),
                         [](const auto& info) { return info.param.name; });

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

}  // namespace
}  // namespace locograph::test
