// The planner allocates nothing once its window has been filled: counted by replacing the allocator of this
// program.

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "gateway/motion/planner.hpp"
#include "gateway/motion/tests/test_machine.hpp"

namespace {
std::atomic<long> allocations{0};
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace kinebus::probe {
namespace {

TEST(Planner, SteadyStateAllocatesNothing) {
  Lines lines = random_print(1, 20000);
  const Lines curve = dense_curve(20000, 30, 100, 0.4, 1);
  lines.insert(lines.end(), curve.begin(), curve.end());
  Planner planner(m1(), MotionLimits{});
  const long before = allocations;
  Phase phase;
  for (const auto& line : lines) {
    ASSERT_TRUE(planner.add(line));
    while (!planner.wants_more() && planner.next(phase)) {
    }
  }
  ASSERT_TRUE(planner.finish());
  while (planner.next(phase)) {
  }
  EXPECT_EQ(allocations - before, 0);
}

}  // namespace
}  // namespace kinebus::probe
