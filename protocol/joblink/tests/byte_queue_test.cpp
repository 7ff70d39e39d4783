#include "protocol/joblink/byte_queue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

namespace kinebus::joblink {
namespace {

std::string text_of(const ByteQueue& queue) {
  const auto bytes = queue.bytes();
  return {bytes.begin(), bytes.end()};
}

TEST(ByteQueue, HoldsWhatAStringWouldHold) {
  const std::uint32_t seed = 1;
  std::mt19937 random(seed);
  ByteQueue queue;
  std::string expected;
  for (int step = 0; step < 20'000; ++step) {
    if (random() % 2 == 0) {
      const std::size_t asked = random() % 200, filled = random() % (asked + 1);
      const auto room = queue.room(asked);
      ASSERT_EQ(room.size(), asked);
      std::fill(room.begin(), room.end(), static_cast<std::uint8_t>(step));
      queue.added(filled);
      expected.append(filled, static_cast<char>(step));
    } else if (random() % 500 == 0) {
      queue.clear();
      expected.clear();
    } else {
      const std::size_t count = random() % (expected.size() + 1);
      queue.drop(count);
      expected.erase(0, count);
    }
    ASSERT_EQ(text_of(queue), expected) << "seed " << seed << ", step " << step;
    ASSERT_EQ(queue.size(), expected.size());
    ASSERT_EQ(queue.empty(), expected.empty());
  }
}

}  // namespace
}  // namespace kinebus::joblink
