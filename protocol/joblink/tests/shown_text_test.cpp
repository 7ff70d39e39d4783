#include "protocol/joblink/shown_text.hpp"

#include <gtest/gtest.h>

namespace kinebus {
namespace {

TEST(ShownText, IsCutBetweenCharacters) {
  const std::string text = "a\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80";  // a, ä, €, a face
  for (std::size_t max = 0; max <= text.size(); ++max) {
    const auto cut = cut_text(text, max);
    EXPECT_LE(cut.size(), max);
    EXPECT_TRUE(is_utf8(cut)) << max;
    EXPECT_EQ(shown(text, max), cut) << max;
    EXPECT_TRUE(max < cut.size() + 4);
  }
  EXPECT_EQ(cut_text(std::string(99, 'x') + "\xC3\xA4", 100), std::string(99, 'x'));
}

TEST(ShownText, HoldsNothingThatADisplayObeys) {
  EXPECT_EQ(shown("\x1B[2J\x07red\x7F"), "?[2J?red?");
  EXPECT_EQ(shown("a\tb\r\nc"), "a b??c");
  EXPECT_EQ(shown(std::string("a\0b", 3)), "a?b");
  EXPECT_EQ(shown("\xC2\x9B"
                  "31m"),
            "?31m");  // CSI, U+009B
  EXPECT_EQ(shown("part\xE2\x80\xAE"
                  "edocg"),
            "part?edocg");  // right-to-left override
  EXPECT_EQ(shown("\xE2\x81\xA6\xE2\x80\x8F\xD8\x9C\xEF\xBB\xBF"), "????");
  EXPECT_EQ(shown_lines("ok\nT:20\x1B\n", 100), "ok\nT:20?\n");
  EXPECT_FALSE(is_plain("a\x1B"));
}

TEST(ShownText, LeavesEveryLanguageAsItIs) {
  const std::string persian = "\xD9\x85\xDB\x8C\xE2\x80\x8C\xD8\xB4\xD9\x88\xD8\xAF";  // with a joiner
  for (const std::string& text : {persian, std::string("\xC4\xB0stanbul \xC3\xB6l\xC3\xA7\xC3\xBC.gcode")}) {
    EXPECT_EQ(shown(text), text);
    EXPECT_TRUE(is_plain(text));
  }
}

TEST(ShownText, BytesThatAreNoUtf8AreQuestionMarks) {
  EXPECT_EQ(shown("a\xFF\xC3"), "a??");
  EXPECT_EQ(shown("\xC0\xAF"), "??");            // a slash in two bytes
  EXPECT_EQ(shown("\xED\xA0\x80"), "???");       // a surrogate
  EXPECT_EQ(shown("\xF4\x90\x80\x80"), "????");  // above U+10FFFF
  EXPECT_FALSE(is_utf8("\xE2\x82"));
}

}  // namespace
}  // namespace kinebus
