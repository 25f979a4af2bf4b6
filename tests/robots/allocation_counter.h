#pragma once
/// Counts calls of malloc and its relatives in this program.
///
///     const long before = allocation_count();
///     state.update(q.data());
///     EXPECT_EQ(allocation_count(), before);

namespace locograph::test {

/// -1 where they cannot be counted (address sanitizer has its own malloc).
long allocation_count();

}  // namespace locograph::test
