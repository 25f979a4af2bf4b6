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
  }
}

TEST_P(EveryKernel, IsParsedFromItsName) {
  const RobustKernel k = kernel();
  EXPECT_EQ(RobustKernel::parse(k.name() + ":" + std::to_string(k.width)), k);
  EXPECT_EQ(RobustKernel::parse(k.name()).width, 1.0);
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
  for (const char* text : {"huber:", "huber:0", "huber:-1", "huber:x", "huber:1x", "huber:nan",
                           "huber:inf", "huber:1e999", "huber:1:2", "huber: 1", ""}) {
    EXPECT_THROW(RobustKernel::parse(text), Error) << text;
  }
}

}  // namespace
}  // namespace locograph
