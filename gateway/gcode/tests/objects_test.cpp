// Objects that are left out, against the same job with all of them.

#include <algorithm>
#include <random>
#include <set>

#include "gateway/gcode/tests/test_support.hpp"

namespace kinebus::gcode {
namespace {

struct Strand {
  Pose from{}, to{};
  double fed = 0, behind = 0;  ///< mm: E of the move; how far the filament was taken back where it begins
};

/// Moves that print, in their order. Fails where one begins elsewhere than the move before it has ended.
std::vector<Strand> strands_of(const std::string& text) {
  Session session;
  session.must(text);
  std::vector<Strand> strands;
  Pose at{};
  double farthest = 0;
  for (const canonical::Line& line : session.commands) {
    Pose to = at;
    if (const auto* move = std::get_if<canonical::Traverse>(&line.command)) {
      to = move->target;
      EXPECT_EQ(to[kAxisE], at[kAxisE]) << "line " << line.line;
    }
    if (const auto* move = std::get_if<canonical::Feed>(&line.command)) to = move->target;
    const bool moves = to[0] != at[0] || to[1] != at[1] || to[2] != at[2];
    if (moves && to[kAxisE] > at[kAxisE]) {
      strands.push_back({at, to, to[kAxisE] - at[kAxisE], farthest - at[kAxisE]});
      EXPECT_EQ(at[kAxisZ], to[kAxisZ]) << "line " << line.line;
    }
    farthest = std::max(farthest, to[kAxisE]);
    at = to;
  }
  return strands;
}

/// A print of objects in changing order, each in a column of its own: X is 100 times its number.
std::string print(std::mt19937_64& random, int objects, bool by_number) {
  const auto chance = [&random](double share) {
    return std::uniform_real_distribution<>(0, 1)(random) < share;
  };
  const auto place = [&random](int object) {
    return " X" + std::to_string(object * 100 + static_cast<int>(random() % 50)) + " Y" +
           std::to_string(static_cast<int>(random() % 50));
  };
  const bool relative = chance(0.5);
  double e = 0;
  const auto feed = [&](double mm) {
    e += mm;
    return " E" + std::to_string(relative ? mm : e);
  };
  std::string text = std::string(relative ? "M83" : "M82") + "\nG1 X0 Y0 Z0.2 F3000\n";
  double back = 0;
  const auto retract = [&](double to) {
    const std::string line = "G1" + feed(back - to) + " F2400\n";
    back = to;
    return line;
  };
  for (int layer = 1; layer <= 4; ++layer) {
    text += "G1 Z" + std::to_string(layer * 0.2) + " F600\n";
    for (int i = 0; i < objects; ++i) {
      const int object = static_cast<int>(random()) & 0x7FFFFFFF;
      const int which = object % objects;
      const std::string name = std::to_string(which);
      const bool early = chance(0.3);
      if (early) text += "G1" + place(which) + " F6000\n";
      text += by_number ? "M486 S" + name + "\n" : "EXCLUDE_OBJECT_START NAME=o" + name + "\n";
      if (!early) text += "G0" + place(which) + "\n";
      if (back > 0) text += retract(0);
      const int lines = 1 + static_cast<int>(random() % 4);
      for (int k = 0; k < lines; ++k) text += "G1" + place(which) + feed(0.5) + " F1200\n";
      if (chance(0.7)) text += retract(chance(0.5) ? 1 : 2);
      if (chance(0.3) && !relative) {
        text += "G92 E0\n";
        e = 0;
      }
      if (chance(0.3)) text += "G10\nG11\n";
      text += by_number ? "M486 S-1\n" : "EXCLUDE_OBJECT_END\n";
      if (chance(0.2))
        text += "G1 Z" + std::to_string(layer * 0.2 + 1) + "\nG1 Z" + std::to_string(layer * 0.2) + "\n";
    }
  }
  return text;
}

TEST(Objects, WhatIsLeftOutLeavesTheOthersAsTheyAre) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    std::mt19937_64 random(seed);
    const int objects = 2 + static_cast<int>(random() % 4);
    const bool by_number = random() % 2 == 0;
    const std::string job = print(random, objects, by_number);
    std::set<int> out;
    std::string header;
    for (int i = 0; i < objects; ++i) {
      if (random() % 2 == 0) continue;
      out.insert(i);
      header += by_number ? "M486 P" + std::to_string(i) + "\n"
                          : "EXCLUDE_OBJECT NAME=O" + std::to_string(i) + "\n";
    }
    std::vector<Strand> wanted;
    for (const Strand& strand : strands_of(job))
      if (out.count(static_cast<int>(strand.to[kAxisX]) / 100) == 0) wanted.push_back(strand);
    const std::vector<Strand> given = strands_of(header + job);
    ASSERT_EQ(given.size(), wanted.size()) << "seed " << seed << "\n" << header << job;
    for (std::size_t i = 0; i < given.size(); ++i) {
      for (std::size_t axis = kAxisX; axis <= kAxisC; ++axis) {
        ASSERT_NEAR(given[i].from[axis], wanted[i].from[axis], 1e-9) << "seed " << seed << ", strand " << i;
        ASSERT_NEAR(given[i].to[axis], wanted[i].to[axis], 1e-9) << "seed " << seed << ", strand " << i;
      }
      ASSERT_NEAR(given[i].fed, wanted[i].fed, 1e-6) << "seed " << seed << ", strand " << i;
      ASSERT_NEAR(given[i].behind, wanted[i].behind, 1e-6) << "seed " << seed << ", strand " << i;
    }
  }
}

TEST(Objects, ASavedStateGoesOnLeavingOut) {
  const std::string before = "M486 P1\nM486 S1\nG1 X100 Z1 F600\nG1 X110 E5";
  const std::string after = "M486 S2\nG0 X200\nG1 X210 E6";
  Session whole, first, second;
  whole.must(before + "\n" + after);
  first.must(before);
  second.interpreter.restore(first.interpreter.state());
  second.must(after);
  const auto a = whole.texts(), b = second.texts();
  ASSERT_GE(b.size(), 3u);
  EXPECT_EQ(a.back().substr(a.back().find(' ')), b.back().substr(b.back().find(' ')));
  EXPECT_EQ(second.commands[0].command.index(), canonical::Command(canonical::SetPosition{}).index());
  EXPECT_EQ(std::get<canonical::SetPosition>(second.commands[0].command).pose[kAxisX], 0)
      << "where the machine stands";
}

}  // namespace
}  // namespace kinebus::gcode
