#include "gateway/status/state.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace kinebus {
namespace {

using S = MachineState;

TEST(State, AStopAndAFaultMayFollowEveryState) {
  for (int i = 0; i < kMachineStates; ++i) {
    const auto state = static_cast<S>(i);
    EXPECT_TRUE(may_follow(state, S::kStopping)) << to_string(state);
    EXPECT_TRUE(may_follow(state, S::kAlarm)) << to_string(state);
  }
}

TEST(State, EveryStateCanBeReachedAndLeft) {
  std::set<S> reached{S::kOff};
  for (bool grown = true; grown;) {
    grown = false;
    for (const S from : std::set<S>(reached))
      for (int to = 0; to < kMachineStates; ++to)
        if (may_follow(from, static_cast<S>(to)) && reached.insert(static_cast<S>(to)).second) grown = true;
  }
  EXPECT_EQ(reached.size(), static_cast<std::size_t>(kMachineStates));
}

TEST(State, NamesAreDistinct) {
  std::set<std::string> names;
  for (int i = 0; i < kMachineStates; ++i) names.insert(std::string(to_string(static_cast<S>(i))));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kMachineStates));
}

}  // namespace
}  // namespace kinebus
