#include <gtest/gtest.h>
#include <locograph/core/fields.h>

#include <bit>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>

namespace locograph {
namespace {

const FileLine kWhere{"plan.g2o", 12, {}};

double through_text(double value) {
  FieldWriter out;
  out.number(value);
  FieldReader in(out.text(), kWhere);
  const double back = in.number();
  in.expect_end();
  return back;
}

std::string through_text(const std::string& word) {
  FieldWriter out;
  out.word(word);
  out.integer(7);
  FieldReader in(out.text(), kWhere);
  const std::string back = in.word();
  EXPECT_EQ(in.integer(), 7) << out.text();
  in.expect_end();
  return back;
}

void expect_error(const std::string& text, const std::function<void(FieldReader&)>& read,
                  const std::string& part) {
  FieldReader in(text, kWhere);
  try {
    read(in);
    ADD_FAILURE() << "'" << text << "' was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), "plan.g2o");
    EXPECT_EQ(error.line(), 12);
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(Fields, EveryFiniteDoubleComesBackBitForBit) {
  std::mt19937_64 engine(1);
  int denormals = 0;
  for (int i = 0; i < 200000; ++i) {
    std::uint64_t bits = engine();
    if (i % 10 == 0) bits &= 0x800fffffffffffffu;
    const double value = std::bit_cast<double>(bits);
    if (!std::isfinite(value)) continue;
    denormals += std::fpclassify(value) == FP_SUBNORMAL;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(through_text(value)), bits) << value;
  }
  EXPECT_GT(denormals, 1000);
}

TEST(Fields, ExtremeDoublesComeBackBitForBit) {
  using Limits = std::numeric_limits<double>;
  for (const double value :
       {0.0, -0.0, Limits::min(), Limits::max(), Limits::lowest(), Limits::denorm_min(),
        -Limits::denorm_min(), Limits::epsilon(), 1.0 + Limits::epsilon(), 0.1, 1.0 / 3.0}) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(through_text(value)),
              std::bit_cast<std::uint64_t>(value))
        << value;
  }
}

TEST(Fields, NumbersAreReadInTheirUsualSpellings) {
  FieldReader in(" 1 -2.5\t+3 .5 6. 1e3 -1E-3 +1.5e+2 007\r", kWhere);
  for (const double expected : {1.0, -2.5, 3.0, 0.5, 6.0, 1000.0, -0.001, 150.0, 7.0}) {
    EXPECT_EQ(in.number(), expected);
  }
  EXPECT_TRUE(in.at_end());
}

TEST(Fields, ANumberTooSmallForADoubleIsZero) {
  FieldReader in("1e-400 -1e-400 0.00001e-4000", kWhere);
  EXPECT_EQ(in.number(), 0.0);
  EXPECT_EQ(in.number(), 0.0);
  EXPECT_EQ(in.number(), 0.0);
}

TEST(Fields, WhatIsNotAFiniteNumberIsAnError) {
  for (const char* text :
       {"x",   "1x",   "1,5",      "--1",   "+-1",    "+",     "-",
        ".",   "1e",   "0x10",     "1.2.3", "nan",    "NaN",   "-nan",
        "inf", "-inf", "Infinity", "1e400", "-1e400", "\"1\"", "1e999999999999"}) {
    expect_error(
        text, [](FieldReader& in) { in.number(); }, "expected a");
  }
  expect_error(
      "  ", [](FieldReader& in) { in.number(); }, "too few fields");
}

TEST(Fields, WhatIsNotAnIntegerIsAnError) {
  for (const char* text : {"1.5", "1e3", "x", "99999999999", "-", "1-2"}) {
    expect_error(
        text, [](FieldReader& in) { in.integer(); }, "is not an integer");
  }
  expect_error(
      "", [](FieldReader& in) { in.integer(); }, "too few fields");
}

TEST(Fields, FieldsLeftOverAreAnErrorThatShowsTheFirst) {
  expect_error(
      "1 2 3",
      [](FieldReader& in) {
        in.integer();
        in.expect_end();
      },
      "too many fields, from '2' on");
}

TEST(Fields, WordsComeBackWhateverTheyHold) {
  for (const char* word : {"map.bt", "", "my map.bt", "tab\tinside", "quote\"inside", "back\\slash",
                           "\"", "\\", "\\\"", "hash#inside", "||", "a|b", " ", "\"#", "#\"",
                           "car\rriage", "plain-ascii_0", "größe"}) {
    EXPECT_EQ(through_text(word), word);
  }
}

TEST(Fields, AWordThatCannotStandOnOneLineIsRefused) {
  FieldWriter out;
  EXPECT_THROW(out.word("two\nlines"), Error);
}

TEST(Fields, AMissingWordAndAQuoteWithoutEndAreErrors) {
  expect_error(
      " \t", [](FieldReader& in) { in.word(); }, "too few fields");
  expect_error(
      "\"abc", [](FieldReader& in) { in.word(); }, "quote without end");
  expect_error(
      "\"abc\\\"", [](FieldReader& in) { in.word(); }, "quote without end");
}

TEST(Fields, PeekShowsTheNextTokenWithoutTakingIt) {
  FieldReader in("  || 3", kWhere);
  EXPECT_EQ(in.peek(), "||");
  EXPECT_EQ(in.word(), "||");
  EXPECT_EQ(in.peek(), "3");
  EXPECT_EQ(in.integer(), 3);
  EXPECT_EQ(in.peek(), "");
}

}  // namespace
}  // namespace locograph
