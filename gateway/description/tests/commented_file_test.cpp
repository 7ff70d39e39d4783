#include "gateway/description/commented_file.hpp"

#include <gtest/gtest.h>

#include "gateway/description/default_machine_file.hpp"
#include "gateway/description/machine_file.hpp"
#include "gateway/description/tests/uncommented_keys.hpp"

namespace kinebus {
namespace {

TEST(CommentedFile, CommentsComeOnceAndOnlyOutsideOfStrings) {
  const std::string_view example =
      "name = \"a # b\"  # what it is called\n\n# Above.\n[joint.X]  # behind\nspeed = 3  # "
      "fast\n[joint.X.homing]\nspeed = 1 # slow\n";
  const std::string text = with_comments(
      "name = \"c # d\"\n\n[joint.Y]\nspeed = 5\n\n[joint.Y.homing]\nspeed = 2\n\n[joint.Z]\nspeed = 6\n",
      std::span(&example, 1), {.header = "# H\n", .tables = {{"joint.Z", "MOTOR2"}}});
  EXPECT_EQ(text,
            "# H\nname = \"c # d\"                  # what it is called\n\n# Above.\n[joint.Y]               "
            "        # behind\n"
            "speed = 5                       # fast\n\n[joint.Y.homing]\nspeed = 2                       # "
            "slow\n\n# MOTOR2\n"
            "[joint.Z]\nspeed = 6\n");
}

TEST(CommentedFile, PartsOfTheFrameAreOfOneKindAndKeepWhatIsSaidOfEach) {
  const std::string_view example =
      "[bodies.fixed.post]  # stands\nfrom_mm = 0  # a corner\n[bodies.fixed.stem]  # hangs\n";
  EXPECT_EQ(with_comments("[bodies.fixed.beam]\nfrom_mm = 1\n\n[bodies.fixed.stem]\nfrom_mm = 2\n",
                          std::span(&example, 1), {}),
            "[bodies.fixed.beam]\nfrom_mm = 1                     # a corner\n\n"
            "[bodies.fixed.stem]             # hangs\nfrom_mm = 2\n");
}

TEST(DefaultMachineFile, SaysSomethingOfEachKeyAndIsReadBackUnchanged) {
  const std::string text = default_machine_file();
  EXPECT_EQ(uncommented_keys(text), "");
  const auto read = parse_machine(text, "machine.toml");
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_TRUE(*read == default_m1());
}

TEST(DefaultMachineFile, AKeyWithoutACommentIsSeenByThisTest) {
  EXPECT_EQ(
      uncommented_keys("a = \"x\"\n[joint.X.homing]\nb = 1  # so much\n[joint.Y.homing]\nb = 2\nc = 3\n"),
      "a\njoint homing c\n");
}

}  // namespace
}  // namespace kinebus
