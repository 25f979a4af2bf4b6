// The table of the kinds of contact, and a kind that a program adds to it. Its closure is tested
// with those of the others (contact_closure_test.cpp).
#include <locograph/common/error.h>

#include <set>

#include "robots/blade_contact.h"
#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

constexpr ContactKind kShippedKinds[] = {ContactKind::kSurface, ContactKind::kPoint,
                                         ContactKind::kGrasp, ContactKind::kWheel};

TEST(ContactKinds, AreFoundByTheirNamesInFiles) {
  const char* names[] = {"surface", "point", "rung", "wheel"};
  for (std::size_t i = 0; i < std::size(kShippedKinds); ++i) {
    EXPECT_EQ(contact_kind_name(kShippedKinds[i]), names[i]);
    EXPECT_EQ(contact_kind_of(names[i]), kShippedKinds[i]);
  }
  EXPECT_FALSE(contact_kind_of("hook"));
  EXPECT_EQ(contact_kind_names("'").find("'surface', 'point', 'rung'"), 0u);
  EXPECT_NE(contact_kind_names().find(" or "), std::string::npos);
}

TEST(ContactKinds, HaveAForceLimitAndEachFieldOnce) {
  for (const ContactKind kind : kShippedKinds) {
    std::set<std::string> attributes;
    for (const EffectorField& field : contact_kind_entry(kind).fields) {
      EXPECT_TRUE(attributes.insert(field.attribute).second) << field.attribute;
    }
    EXPECT_TRUE(attributes.contains("max_force")) << contact_kind_name(kind);
  }
}

TEST(ContactKinds, ThatAreNoneAreRefused) {
  EXPECT_THROW(contact_kind_entry(static_cast<ContactKind>(1000)), Error);
  EXPECT_THROW(contact_kind_entry(static_cast<ContactKind>(-1)), Error);
}

class AddedKind : public testing::Test {
 protected:
  Contact skate() const {
    return {.effector = {.link = "ball1_tip",
                         .kind = blade(),
                         .half_y_m = 0.1,
                         .friction = 0.5,
                         .max_force_N = 500.0},
            .position = {0.3, -0.2, 0.1},
            .normal = {0.1, 0.2, 1.0},
            .forward = Eigen::Vector3d::UnitX()};
  }
  std::string refusal(const Contact& contact) const {
    try {
      require_sound_contact(robot, contact);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  Robot robot = Robot::load(model("centauro/centauro.urdf"), model("centauro/centauro.srdf"));
};

TEST_F(AddedKind, IsFoundByItsNameAndHasItOnce) {
  EXPECT_EQ(contact_kind_name(blade()), "blade");
  EXPECT_EQ(contact_kind_of("blade"), blade());
  static const BladeContact second;
  EXPECT_THROW(add_contact_kind(second), Error);
}

TEST_F(AddedKind, IsSoundByItsFieldsAndAxes) {
  EXPECT_EQ(refusal(skate()), "");
  Contact bad = skate();
  bad.effector.half_y_m = 0.0;
  EXPECT_NE(refusal(bad).find("half size y"), std::string::npos);
  bad = skate();
  bad.effector.friction = -0.5;
  EXPECT_NE(refusal(bad).find("friction coefficient"), std::string::npos);
  bad = skate();
  bad.effector.forward = bad.effector.normal;
  EXPECT_NE(refusal(bad).find("along its normal"), std::string::npos);
  bad = skate();
  bad.forward.reset();
  EXPECT_NE(refusal(bad).find("is a blade without forward"), std::string::npos);
  bad = skate();
  bad.locked = true;
  EXPECT_NE(refusal(bad).find("wheels only"), std::string::npos);
}

TEST_F(AddedKind, HasRaysOnTheFacesOfItsWrenchCone) {
  const Contact contact = skate();
  const auto cone = contact_kind_entry(blade()).wrench_cone(contact, {});
  const Eigen::Matrix3d axes = axes_in_world(contact);
  for (const double margin : {0.0, 0.1}) {
    const std::vector<BearingRay> rays = bearing_rays({contact}, margin, 1000.0);
    EXPECT_EQ(rays.size(), 4u);
    for (const BearingRay& ray : rays) {
      const Eigen::Vector3d force = axes.transpose() * ray.force;
      const Eigen::Vector3d moment =
          axes.transpose() * ((ray.at - contact.position).cross(ray.force) + ray.moment);
      const Eigen::Vector3d w(force.x(), force.z(), moment.x());
      double worst = -1.0;
      for (int i = 0; i < cone->rows(); ++i) {
        const WrenchRow row = cone->row(i, w.data());
        worst = std::max(worst, row.gradient.head<3>().dot(w) + row.offset);
      }
      EXPECT_LE(worst, 1e-12);
      EXPECT_EQ(worst > -1e-12, margin == 0.0);
    }
  }
  EXPECT_EQ(most_of_rays(contact, 0.1, 1000.0), 0.9 * 500.0 / 1000.0);
}

}  // namespace
}  // namespace locograph::test
