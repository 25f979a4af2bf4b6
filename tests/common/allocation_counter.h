#pragma once
/// Counts the allocations of this program: link allocation_counter.cpp into it.
///
///     const long before = allocation_count();
///     optimiser.iterate();
///     EXPECT_EQ(allocation_count(), before);

namespace locograph::test {

/// Whether they can be counted: not where a sanitizer brings its own malloc.
bool allocations_are_counted();
/// Calls of malloc and its relatives so far, operator new included.
long allocation_count();

}  // namespace locograph::test
