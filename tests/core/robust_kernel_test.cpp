#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/core/robust_kernel.h>

#include <cmath>

namespace locograph {
namespace {

class EveryKernel : public testing::TestWithParam<std::tuple<std::string, double>> {
 protected:
  RobustKernel kernel() const {
    RobustKernel kernel = RobustKernel::parse(std::get<0>(GetParam()));
    kernel.width = std::get<1>(GetParam());
    return kernel;
  }
};
INSTANTIATE_TEST_SUITE_P(RobustKernel, EveryKernel,
                         testing::Combine(testing::ValuesIn(RobustKernel::names()),
                                          testing::Values(0.3, 1.0, 5.0)));

TEST_P(EveryKernel, StartsAtZeroWithSlopeOne) {
  const RobustKernel::Weights at_zero = kernel().weights(0.0);
  EXPECT_EQ(at_zero.cost, 0.0);
  EXPECT_EQ(at_zero.weight, 1.0);
}

TEST_P(EveryKernel, WeightIsTheDerivativeOfTheCost) {
  const RobustKernel k = kernel();
  const double c2 = k.width * k.width;
  for (double u = 0.01; u < 30.0; u *= 1.37) {
    const double s = u * c2, h = 1e-5 * s;
    if (std::abs(s - c2) < 2.0 * h) continue;  // where some kernels have a kink
    const double slope = (k.weights(s + h).cost - k.weights(s - h).cost) / (2.0 * h);
    EXPECT_NEAR(k.weights(s).weight, slope, 1e-7) << "at " << u << " widths squared";
  }
}

TEST_P(EveryKernel, CurvatureIsTheDerivativeOfTheWeight) {
  const RobustKernel k = kernel();
  const double c2 = k.width * k.width;
  for (double u = 0.01; u < 30.0; u *= 1.37) {
    const double s = u * c2, h = 1e-5 * s;
    if (std::abs(s - c2) < 2.0 * h) continue;
    const double slope = (k.weights(s + h).weight - k.weights(s - h).weight) / (2.0 * h);
    EXPECT_NEAR(k.weights(s).curvature * s, slope * s, 1e-7) << "at " << u << " widths squared";
  }
}

TEST_P(EveryKernel, CorrectionKeepsTheInformationPositiveSemiDefinite) {
  RobustKernel k = kernel();
  for (double u = 0.0; u < 50.0; u += 0.01) {
    const double s = u * k.width * k.width;
    const RobustKernel::Weights w = k.weights(s);
    EXPECT_EQ(k.correction(s, w), 0.0);
    k.second_order = true;
    // The eigenvalue of I + β r rᵀ along r, where rᵀr = s.
    EXPECT_GE(1.0 + s * k.correction(s, w), 0.0) << u;
    EXPECT_LE(k.correction(s, w), 0.0) << u;
    k.second_order = false;
  }
}

TEST_P(EveryKernel, CostRisesAndWeightFallsWithoutJumpsInTheCost) {
  const RobustKernel k = kernel();
  const double c2 = k.width * k.width;
  RobustKernel::Weights before = k.weights(0.0);
  for (double u = 0.001; u < 50.0; u += 0.001) {
    const RobustKernel::Weights now = k.weights(u * c2);
    ASSERT_GE(now.cost, before.cost) << u;
    ASSERT_LE(now.cost - before.cost, 0.001 * c2 * (1.0 + 1e-6)) << u;
    ASSERT_LE(now.weight, before.weight) << u;
    ASSERT_GE(now.weight, 0.0) << u;
    before = now;
  }
}

TEST_P(EveryKernel, StaysFiniteForHugeErrors) {
  for (const double s : {1e20, 1e100, 1e300}) {
    const RobustKernel::Weights w = kernel().weights(s);
    EXPECT_TRUE(std::isfinite(w.cost)) << s;
    EXPECT_TRUE(std::isfinite(w.weight)) << s;
    EXPECT_TRUE(std::isfinite(w.curvature)) << s;
  }
}

TEST_P(EveryKernel, IsParsedFromItsName) {
  const RobustKernel k = kernel();
  EXPECT_EQ(RobustKernel::parse(k.name() + ":" + std::to_string(k.width)), k);
  EXPECT_EQ(RobustKernel::parse(k.name()).width, 1.0);
  RobustKernel second_order = k;
  second_order.second_order = true;
  EXPECT_EQ(RobustKernel::parse(k.name() + ":" + std::to_string(k.width) + ":second-order"),
            second_order);
}

RobustKernel barron(double width, double alpha) {
  return {RobustKernel::Kind::kBarron, width, alpha};
}

TEST(BarronKernel, CostWeightAndCurvatureAgreeForEveryShape) {
  for (const double alpha : {-1e300, -1e6, -10.0, -2.0, -1.0, -1e-3, -1e-14, 0.0, 1e-14, 1e-3, 0.5,
                             1.0, 1.5, 1.999, 2.0 - 1e-7, 2.0}) {
    const RobustKernel k = barron(0.7, alpha);
    for (double s = 0.01; s < 20.0; s *= 1.3) {
      const double h = 1e-5 * s;
      const RobustKernel::Weights low = k.weights(s - h), high = k.weights(s + h), w = k.weights(s);
      EXPECT_NEAR(w.weight, (high.cost - low.cost) / (2.0 * h), 1e-8) << alpha << " at " << s;
      EXPECT_NEAR(w.curvature * s, (high.weight - low.weight) / (2.0 * h) * s, 1e-8)
          << alpha << " at " << s;
    }
  }
}

TEST(BarronKernel, HasTheOthersAsSpecialCases) {
  const double width = 0.7, s2 = std::sqrt(2.0);
  const auto expect_same = [](const RobustKernel& a, const RobustKernel& b) {
    for (double s = 0.0; s < 20.0; s = 1.3 * s + 0.01) {
      const RobustKernel::Weights wa = a.weights(s), wb = b.weights(s);
      EXPECT_NEAR(wa.cost, wb.cost, 1e-13 * (1.0 + wb.cost)) << b.name() << " at " << s;
      EXPECT_NEAR(wa.weight, wb.weight, 1e-13) << b.name() << " at " << s;
      EXPECT_NEAR(wa.curvature, wb.curvature, 1e-12) << b.name() << " at " << s;
    }
  };
  const double infinity = std::numeric_limits<double>::infinity();
  using Kind = RobustKernel::Kind;
  expect_same(barron(width, 2.0), RobustKernel());
  expect_same(barron(width, 1.0), {Kind::kPseudoHuber, width});
  expect_same(barron(width, 0.0), {Kind::kCauchy, s2 * width});
  expect_same(barron(width, -2.0), {Kind::kGemanMcClure, 2.0 * width});
  expect_same(barron(width, -infinity), {Kind::kWelsch, s2 * width});
}

TEST(BarronKernel, ApproachesItsLimitsWithoutAJump) {
  const double infinity = std::numeric_limits<double>::infinity();
  const std::pair<double, double> near_and_limit[] = {
      {1e-9, 0.0}, {-1e-9, 0.0}, {2.0 - 1e-8, 2.0}, {-1e9, -infinity}, {-1e300, -infinity}};
  for (const auto& [near, limit] : near_and_limit) {
    for (double s = 0.0; s < 1e4; s = 1.5 * s + 0.01) {
      const RobustKernel::Weights a = barron(1.0, near).weights(s);
      const RobustKernel::Weights b = barron(1.0, limit).weights(s);
      EXPECT_NEAR(a.cost, b.cost, 1e-6 * (1.0 + b.cost)) << near << " at " << s;
      EXPECT_NEAR(a.weight, b.weight, 1e-6) << near << " at " << s;
    }
  }
}

TEST(BarronKernel, StaysFiniteForHugeErrorsOfEveryShape) {
  for (const double alpha : {-1e300, -3.0, 0.0, 1.0, 2.0 - 2e-9, 2.0}) {
    for (const double s : {0.0, 1e-300, 1e20, 1e300}) {
      for (const double width : {1e-3, 1.0, 1e3}) {
        const RobustKernel::Weights w = barron(width, alpha).weights(s);
        EXPECT_TRUE(std::isfinite(w.cost)) << alpha << " " << s;
        EXPECT_TRUE(w.weight >= 0.0 && w.weight <= 1.0) << alpha << " " << s << " " << w.weight;
        EXPECT_TRUE(std::isfinite(w.curvature)) << alpha << " " << s;
      }
    }
  }
}

TEST(BarronKernel, IsParsedWithItsShape) {
  EXPECT_EQ(RobustKernel::parse("barron"), barron(1.0, 1.0));
  EXPECT_EQ(RobustKernel::parse("barron:0.5:-2"), barron(0.5, -2.0));
  EXPECT_EQ(RobustKernel::parse("barron:0.5:-inf"),
            barron(0.5, -std::numeric_limits<double>::infinity()));
  EXPECT_TRUE(RobustKernel::parse("barron:0.5:-2:second-order").second_order);
  for (const char* text : {"barron:1:2.1", "barron:1:inf", "barron:1:nan", "barron:1:",
                           "barron:1:x", "barron:1:1:1", "barron::1", "barron:1:1:second-order:"}) {
    EXPECT_THROW(RobustKernel::parse(text), Error) << text;
  }
}

TEST(GraduatedKernel, GoesFromNearlyConvexToTruncated) {
  const double width = 2.0;
  for (const double mu : {0.01, 0.3, 1.0, 10.0}) {
    const RobustKernel k(RobustKernel::Kind::kSaturated, width, mu);
    for (double s = 0.01; s < 1.2 * (mu + 1.0) / mu * width * width; s *= 1.05) {
      const double h = 1e-5 * s;
      const RobustKernel::Weights low = k.weights(s - h), high = k.weights(s + h), w = k.weights(s);
      EXPECT_NEAR(w.weight, (high.cost - low.cost) / (2.0 * h), 1e-5) << mu << " at " << s;
      EXPECT_LE(w.cost, width * width * (1.0 + 1e-12));
    }
  }
  const RobustKernel sharp(RobustKernel::Kind::kSaturated, width);
  const RobustKernel nearly(RobustKernel::Kind::kSaturated, width, 1e9);
  for (const double s : {0.1, 3.99, 4.01, 50.0}) {
    EXPECT_NEAR(nearly.weights(s).cost, sharp.weights(s).cost, 1e-6) << s;
    EXPECT_NEAR(nearly.weights(s).weight, sharp.weights(s).weight, 1e-6) << s;
  }
}

TEST(RobustKernel, ThatIsUnknownIsAnErrorNamingTheKnownOnes) {
  try {
    RobustKernel::parse("hubert:1");
    FAIL() << "no error";
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("'hubert'"), std::string::npos) << message;
    for (const std::string& name : RobustKernel::names()) {
      EXPECT_NE(message.find(name), std::string::npos) << message;
    }
  }
}

TEST(RobustKernel, WidthMustBeAPositiveFiniteNumber) {
  for (const char* text :
       {"huber:", "huber:0", "huber:-1", "huber:x", "huber:1x", "huber:nan", "huber:inf",
        "huber:1e999", "huber:1:2", "huber: 1", "", "huber:second-order:1", "huber:1:first-order",
        "huber:1:second-order:"}) {
    EXPECT_THROW(RobustKernel::parse(text), Error) << text;
  }
}

}  // namespace
}  // namespace locograph
