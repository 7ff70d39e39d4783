// One user of a file is changed, and nothing else in it.

#include "gateway/sessions/http/users_text.hpp"

#include <gtest/gtest.h>

namespace kinebus::http {
namespace {

constexpr const char* kGatewayKey = "0123456789abcdef";
constexpr const char* kKept = R"(# Who prints here.
[[user]]
name = "Ayşe \"A\""  # the workshop's
role = "watch"        # only looks
key = "a-key-of-sixteen-1"

# The telephone on the wall.
[[user]]
  key = 'a-key-of-sixteen-2'
  role = 'operate'
  name = 'wall'
[[trusted]]
network = "10.0.0.0/24"
role = "watch"
)";

std::string changed(std::string text, const std::string& from, const std::string& into) {
  return text.replace(text.find(from), from.size(), into);
}
UsersText of(const std::string& text) {
  return UsersText(text, kGatewayKey);
}

TEST(UsersText, ARoleOrAKeyIsChangedInItsPlace) {
  EXPECT_EQ(of(kKept).with_role("Ayşe \"A\"", Role::kAdminister),
            changed(kKept, "\"watch\"        #", "\"administer\"        #"));
  EXPECT_EQ(of(kKept).with_key("wall", "another-key-of-16-\"\\"),
            changed(kKept, "'a-key-of-sixteen-2'", "\"another-key-of-16-\\\"\\\\\""));
  const std::string inline_tables =
      "user = [{name=\"Ünal\", role=\"watch\", key=\"a-key-of-sixteen-1\"}, {name=\"b\", role=\"watch\", "
      "key=\"a-key-of-sixteen-2\"}]\n";
  EXPECT_EQ(of(inline_tables).with_role("Ünal", Role::kOperate),
            changed(inline_tables, "\"watch\"", "\"operate\""));
}

TEST(UsersText, AUserComesAndGoes) {
  const User cem{.visitor = {"cem", Role::kOperate, true}, .key = "a-key-of-sixteen-3"};
  const auto more = of(kKept).with(cem);
  ASSERT_TRUE(more) << more.error();
  EXPECT_EQ(*more, std::string(kKept) +
                       "[[user]]\nname = \"cem\"\nrole = \"operate\"\nkey = \"a-key-of-sixteen-3\"\n");
  EXPECT_EQ(of(*more).without("cem"), kKept);
  const auto fewer = of(kKept).without("wall");
  ASSERT_TRUE(fewer) << fewer.error();
  EXPECT_EQ(fewer->find("sixteen-2"), std::string::npos);
  EXPECT_NE(fewer->find("10.0.0.0/24"), std::string::npos);
  const auto first = of("").with(cem);
  ASSERT_TRUE(first) << first.error();
  EXPECT_EQ(of(*first).without("cem"), "");
  EXPECT_TRUE(of("# no end of line").with(cem));
}

TEST(UsersText, WhatCannotBeIsSaid) {
  const auto why = [](const Result<std::string, std::string>& result) {
    return result ? "" : result.error();
  };
  const auto user = [](std::string name, std::string key) {
    return User{.visitor = {std::move(name), Role::kWatch, true}, .key = std::move(key)};
  };
  EXPECT_EQ(why(of(kKept).with(user("wall", "a-key-of-sixteen-3"))), "there is a user 'wall' already");
  EXPECT_EQ(why(of(kKept).without("walls")), "there is no user 'walls'");
  EXPECT_EQ(why(of(kKept).without("")), "there is no user ''");
  EXPECT_EQ(why(of(kKept).with_role("b", Role::kWatch)), "there is no user 'b'");
  EXPECT_NE(why(of(kKept).with(user("b", "a-key-of-sixteen-2"))).find("or the key of another"),
            std::string::npos);
  EXPECT_NE(why(of(kKept).with(user("b", kGatewayKey))).find("or the key of another"), std::string::npos);
  EXPECT_NE(why(of(kKept).with_key("wall", "short")).find("too short"), std::string::npos);
  EXPECT_NE(why(of(kKept).with(user("", "a-key-of-sixteen-3"))).find("a user has a name"), std::string::npos);
  EXPECT_NE(why(of(kKept).with(user("a\nb", "a-key-of-sixteen-3"))).find("no control characters"),
            std::string::npos);
  EXPECT_NE(why(of("[[user]]\nname = 5\n").with(user("b", "a-key-of-sixteen-3"))).find("line 1"),
            std::string::npos);
  // Several on a line: taking the line would take both.
  const std::string inline_tables =
      "user = [{name=\"a\", role=\"watch\", key=\"a-key-of-sixteen-1\"}, {name=\"b\", role=\"watch\", "
      "key=\"a-key-of-sixteen-2\"}]\n";
  EXPECT_NE(why(of(inline_tables).without("a")).find("by an editor alone"), std::string::npos);
}

}  // namespace
}  // namespace kinebus::http
