#include "gateway/fleet/gateways_file.hpp"

#include <gtest/gtest.h>

namespace kinebus::fleet {
namespace {

TEST(GatewaysFile, TellsMachinesAndHowTheyAreReached) {
  const auto read = read_gateways(
      "[[gateway]]\nname = \"a\"\nsocket = \"/run/a\"\nkind = \"m1\"\nmaterial = \"PLA\"\nnozzle_mm = 0.4\n"
      "[[gateway]]\nname = \"b\"\ntcp = \"b:7\"\nfingerprint = \"00\"\ntoken_file = \"/t\"\n");
  ASSERT_TRUE(read);
  ASSERT_EQ(read->size(), 2U);
  EXPECT_EQ((*read)[0].machine.kind, "m1");
  EXPECT_EQ((*read)[0].machine.nozzle_mm, 0.4);
  EXPECT_EQ((*read)[0].reach.socket, "/run/a");
  EXPECT_EQ((*read)[1].reach.tcp, "b:7");
}

TEST(GatewaysFile, RefusesWhatIsWrongWithItsPlace) {
  const struct {
    const char *text, *words;
  } kCases[] = {
      {"", "line 1: expected [[gateway]], one for each machine"},
      {"gateway = 3", "line 1: expected [[gateway]], one for each machine"},
      {"x = 3", "line 1: there is no 'x' in such a file; expected [[gateway]]"},
      {"[[gateway]]\nsocket = \"s\"", "line 1: a gateway has a name"},
      {"[[gateway]]\nname = \"a/b\"",
       "line 1: name: expected letters without accents, digits, - and _ alone"},
      {"[[gateway]]\nname = \"a\"", "line 1: expected socket or tcp, one of them"},
      {"[[gateway]]\nname = 3", "line 2: name: expected a text in quotes"},
      {"[[gateway]]\nname = \"a\"\nsocket = \"s\"\nnozzle_mm = -1",
       "line 4: nozzle_mm: expected a number above 0"},
      {"[[gateway]]\nname = \"a\"\nsocket = \"s\"\n[[gateway]]\nname = \"a\"\nsocket = \"t\"",
       "line 4: the name 'a' is there twice"},
  };
  for (const auto& c : kCases) {
    const auto read = read_gateways(c.text);
    ASSERT_FALSE(read) << c.text;
    EXPECT_EQ(read.error(), c.words) << c.text;
  }
}

}  // namespace
}  // namespace kinebus::fleet
