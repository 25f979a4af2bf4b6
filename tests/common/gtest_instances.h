#pragma once
/// GoogleTest's messages about the values that tests compare most: instantiated once for all.

#include <gtest/gtest.h>

#include <string>

#define LOCOGRAPH_GTEST_INSTANCES(EXTERN)                    \
  LOCOGRAPH_GTEST_INSTANCE(EXTERN, bool, bool)               \
  LOCOGRAPH_GTEST_INSTANCE(EXTERN, int, int)                 \
  LOCOGRAPH_GTEST_INSTANCE(EXTERN, long, int)                \
  LOCOGRAPH_GTEST_INSTANCE(EXTERN, long, long)               \
  LOCOGRAPH_GTEST_INSTANCE(EXTERN, double, double)           \
  LOCOGRAPH_GTEST_INSTANCE(EXTERN, std::size_t, int)         \
  LOCOGRAPH_GTEST_INSTANCE(EXTERN, std::size_t, unsigned)    \
  LOCOGRAPH_GTEST_INSTANCE(EXTERN, std::size_t, std::size_t) \
  LOCOGRAPH_GTEST_INSTANCE(EXTERN, std::string, std::string)

#define LOCOGRAPH_GTEST_INSTANCE(EXTERN, A, B)                                                     \
  EXTERN template AssertionResult CmpHelperEQFailure(const char*, const char*, const A&,           \
                                                     const B&);                                    \
  EXTERN template AssertionResult CmpHelperOpFailure(const char*, const char*, const A&, const B&, \
                                                     const char*);

namespace testing::internal {
LOCOGRAPH_GTEST_INSTANCES(extern)
}
