#include "gateway/stream/stream_error.hpp"

#include <gtest/gtest.h>

namespace kinebus {
namespace {

std::string words(const StreamError& error) {
  return to_string(error).english();
}

TEST(StreamError, NamesWhatItKnowsAndNothingElse) {
  using Kind = StreamError::Kind;
  EXPECT_EQ(words({.kind = Kind::kUnderrun}), "the node ran out of records");
  EXPECT_EQ(words({.kind = Kind::kSilent, .node_id = 3, .line = 17, .amount = 412.5}),
            "records were sent but not accepted (ms): 412.5, node 3, line 17");
  EXPECT_EQ(words({.kind = Kind::kStartMismatch, .node_id = 1, .axis = 0, .amount = 5}),
            "the run does not start where the axis stands (counts apart): 5, node 1 axis A");
  EXPECT_EQ(words({.kind = Kind::kStartMismatch, .node_id = 1, .axis = 1, .amount = 5}),
            "the run does not start where the axis stands (counts apart): 5, node 1 axis B");
  EXPECT_EQ(words({.kind = Kind::kCheckpoint, .line = 2}),
            "the node's state differs from the gateway's, line 2");
  StreamError pose{.kind = Kind::kPose, .line = 9};
  pose.pose.kind = PoseError::Kind::kOutOfReach;
  EXPECT_EQ(words(pose),
            "the path leaves the machine's reach: " + to_string(pose.pose).english() + ", line 9");
}

}  // namespace
}  // namespace kinebus
