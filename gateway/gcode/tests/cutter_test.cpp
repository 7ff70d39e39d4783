// Cutter compensation, measured from its moves: how near the tool comes to the programmed path.

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "gateway/gcode/programs/job_reader.hpp"
#include "gateway/gcode/tests/test_support.hpp"

namespace kinebus::gcode {
namespace {

constexpr double kPi = std::numbers::pi;

struct Point {
  double x = 0, y = 0;
};
double apart(const Point& a, const Point& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

/// A line, or an arc from angle `begin` over `sweep` (< 0: clockwise).
struct Stretch {
  bool arc = false;
  Point from{}, to{}, centre{};
  double radius = 0, begin = 0, sweep = 0;

  Point at(double t) const {
    if (!arc) return {from.x + (to.x - from.x) * t, from.y + (to.y - from.y) * t};
    return {centre.x + radius * std::cos(begin + sweep * t), centre.y + radius * std::sin(begin + sweep * t)};
  }
  double distance(const Point& p) const {
    if (arc) {
      double angle = std::atan2(p.y - centre.y, p.x - centre.x) - begin;
      if (sweep < 0) angle = -angle;
      angle = std::fmod(angle + 4 * kPi, 2 * kPi);
      if (angle <= std::abs(sweep)) return std::abs(apart(p, centre) - radius);
      return std::min(apart(p, from), apart(p, to));
    }
    const double dx = to.x - from.x, dy = to.y - from.y;
    const double t = ((p.x - from.x) * dx + (p.y - from.y) * dy) / (dx * dx + dy * dy);
    return apart(p, at(std::clamp(t, 0.0, 1.0)));
  }
};

std::string number(double value) {
  return std::to_string(std::round(value * 1e4) / 1e4);
}

struct Contour {
  std::string text;
  std::map<std::uint32_t, Stretch> walls;  ///< by line
  double radius = 0;
};

/// A lead-in, then lines and arcs at random corners.
Contour random_contour(std::mt19937& random) {
  const auto from_to = [&](double a, double b) { return std::uniform_real_distribution(a, b)(random); };
  const auto rounded = [](Point p) {
    return Point{std::round(p.x * 1e4) / 1e4, std::round(p.y * 1e4) / 1e4};
  };
  Contour made;
  made.radius = std::array{0.5, 1.0, 2.0, 3.0}[random() % 4];
  double heading = from_to(-kPi, kPi);
  Point at = rounded({20 * std::cos(heading), 20 * std::sin(heading)});
  made.text = "F600\n";
  made.text.append(random() % 2 != 0 ? "G41.1 D" : "G42.1 D").append(number(2 * made.radius));
  made.text.append(" G1 X").append(number(at.x)).append(" Y").append(number(at.y)).append("\n");
  std::uint32_t in_line = 2;
  const auto moves = 3 + random() % 10;
  for (unsigned i = 0; i < moves; ++i) {
    if (random() % 5 != 0) heading += from_to(-1.4, 1.4);
    Stretch wall;
    wall.from = at;
    if (random() % 2 != 0) {
      const double length = from_to(0.3, 25);
      wall.to = rounded({at.x + length * std::cos(heading), at.y + length * std::sin(heading)});
      made.text += "G1 X" + number(wall.to.x) + " Y" + number(wall.to.y) + "\n";
    } else {
      wall.arc = true;
      const double radius = from_to(0.6, 15), left = random() % 2 != 0 ? 1 : -1;
      wall.sweep = left * from_to(0.2, 4.5);
      wall.centre =
          rounded({at.x - left * radius * std::sin(heading), at.y + left * radius * std::cos(heading)});
      wall.radius = apart(at, wall.centre);
      wall.begin = std::atan2(at.y - wall.centre.y, at.x - wall.centre.x);
      wall.to = rounded(wall.at(1));
      made.text += (left > 0 ? "G3 X" : "G2 X") + number(wall.to.x) + " Y" + number(wall.to.y) + " I" +
                   number(wall.centre.x - at.x) + " J" + number(wall.centre.y - at.y) + "\n";
      heading += wall.sweep;
    }
    made.walls[++in_line] = wall;
    at = wall.to;
  }
  made.text += "G40 G1 X" + number(at.x + 30 * std::cos(heading)) + " Y" +
               number(at.y + 30 * std::sin(heading)) + "\n";
  return made;
}

/// Whether the programmed path crosses or nearly touches itself there, but for the corner of neighbours.
bool meet(const Contour& contour, std::uint32_t a, std::uint32_t b) {
  const auto wall = contour.walls.find(a), other = contour.walls.find(b);
  if (a == b || wall == contour.walls.end() || other == contour.walls.end()) return false;
  const bool neighbours = a + 1 == b || b + 1 == a;
  const Point corner = a < b ? wall->second.to : wall->second.from;
  for (int i = 0; i <= 1000; ++i) {
    const Point p = wall->second.at(i / 1000.0);
    if (neighbours && apart(p, corner) < 0.5) continue;
    if (other->second.distance(p) < 0.1) return true;
  }
  return false;
}

/// The tool's path between lead-in and lead-out, with the lines that it belongs to.
std::vector<std::pair<std::uint32_t, Stretch>> tool_path(const CommandBuffer& commands,
                                                         std::uint32_t last_line) {
  std::vector<std::pair<std::uint32_t, Stretch>> path;
  Point at{};
  for (const canonical::Line& command : commands) {
    Stretch piece;
    piece.from = at;
    if (const auto* move = std::get_if<canonical::Feed>(&command.command)) {
      piece.to = {move->target[0], move->target[1]};
    } else if (const auto* arc = std::get_if<canonical::Arc>(&command.command)) {
      piece.arc = true;
      piece.to = {arc->target[0], arc->target[1]};
      piece.centre = {arc->centre_mm[0], arc->centre_mm[1]};
      piece.radius = apart(at, piece.centre);
      piece.begin = std::atan2(at.y - piece.centre.y, at.x - piece.centre.x);
      piece.sweep = arc->normal[2] * arc->sweep_rad;
      // As the planner reads an arc: it ends where its sweep says.
      EXPECT_LT(apart(piece.at(1), piece.to), 0.011) << "line " << command.line;
    } else {
      continue;
    }
    at = piece.to;
    if (command.line > 2 && command.line <= last_line) path.emplace_back(command.line, piece);
  }
  return path;
}

TEST(Cutter, TheToolKeepsItsRadiusFromTheProgrammedPath) {
  int accepted = 0, refused = 0;
  for (unsigned seed = 1; seed <= 1500; ++seed) {
    std::mt19937 random(seed);
    const Contour contour = random_contour(random);
    Interpreter interpreter;
    JobReader reader(interpreter);
    CommandBuffer commands;
    auto read = reader.read(contour.text, commands);
    if (read) read = reader.finish(commands);
    if (!read) {
      ++refused;
      continue;
    }
    ++accepted;
    const std::uint32_t last = contour.walls.rbegin()->first;
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> nearest_to;
    for (const auto& [in_line, piece] : tool_path(commands, last)) {
      for (int i = 0; i <= 25; ++i) {
        const Point p = piece.at(i / 25.0);
        double nearest = 1e9;
        for (const auto& [other, wall] : contour.walls) {
          const double distance = wall.distance(p);
          nearest = std::min(nearest, distance);
          double& least = nearest_to.try_emplace({in_line, other}, 1e9).first->second;
          least = std::min(least, distance);
        }
        ASSERT_LT(nearest, contour.radius + 1e-3) << "seed " << seed << ", line " << in_line << "\n"
                                                  << contour.text;
      }
    }
    const double too_near = contour.radius - 1e-3;
    for (const auto& [lines, least] : nearest_to) {
      const auto [a, b] = lines;
      if (least >= too_near) continue;
      ASSERT_NE(a, b) << "seed " << seed << ": " << least << " mm beside line " << a << "\n" << contour.text;
      const auto other = nearest_to.find({b, a});
      if (other == nearest_to.end() || other->second >= too_near) continue;
      ASSERT_TRUE(meet(contour, a, b) || meet(contour, a - 1, b) || meet(contour, b - 1, a) ||
                  meet(contour, a - 1, b - 1))
          << "seed " << seed << ": lines " << a << " and " << b << " cut one another\n"
          << contour.text;
    }
  }
  EXPECT_GT(accepted, 400);
  EXPECT_GT(refused, 400);
}

TEST(Cutter, ARefusedLineLeavesTheHeldMoveAsItWas) {
  const char* const before = "F600\nG41 D1 G1 X20\nX40 Y5\nG1 Z-1\n";
  const char* const after = "X60 Y30\nG40 G1 X0\n";
  Options options;
  options.tool_diameter_mm = {6};
  Session plain(options), disturbed(options);
  plain.must(before);
  plain.must(after);
  disturbed.must(before);
  for (const char* line :
       {"X39 Y5.1", "G3 X44 I2", "X50 A1", "G28", "G41 D1", "G1 X50 Y40 Q3", "G92 X0", "M6"})
    EXPECT_NE(disturbed.run(line), "") << line;
  disturbed.number = plain.number - 2;
  disturbed.must(after);
  EXPECT_EQ(plain.texts(), disturbed.texts());
}

TEST(Cutter, ANegativeDiameterIsTheOtherSide) {
  const char* const path = " G1 X20\nX40 Y10\nY-10\nG40 G1 X0\n";
  Session left, right;
  left.must("F600\nG41.1 D-6" + std::string(path));
  right.must("F600\nG42.1 D6" + std::string(path));
  EXPECT_EQ(left.texts(), right.texts());
}

TEST(Cutter, ALathesTipIsWhereItsOrientationSaysFromTheMiddle) {
  const char* const path = " G1 Z-5 X10\nZ-20\nG3 X14 Z-24 I0 K-4\nG1 X20\nG40 G1 X30 Z0\n";
  const std::string begin = "G18 F600\nG0 X5 Z2\nG42.1 D0.8";
  Session middle;
  middle.must(begin + path);
  const auto plain = middle.all<canonical::Feed>();
  const auto arcs = middle.all<canonical::Arc>();
  ASSERT_EQ(plain.size(), 4U);
  ASSERT_FALSE(arcs.empty());
  // Of X and Z, as the table of LinuxCNC's orientations draws them.
  constexpr double kTipX[] = {0, -1, -1, 1, 1, 0, -1, 0, 1, 0};
  constexpr double kTipZ[] = {0, 1, -1, -1, 1, 1, 0, -1, 0, 0};
  for (int orientation = 0; orientation <= 9; ++orientation) {
    const double x = 0.4 * kTipX[orientation], z = 0.4 * kTipZ[orientation];
    Session by_word, by_table;
    by_word.must(begin + " L" + std::to_string(orientation) + path);
    by_table.must("G10 L1 P5 R0.4 Q" + std::to_string(orientation) + "\nG18 F600\nG0 X5 Z2\nG42 D5" + path);
    for (const Session* session : {&by_word, &by_table}) {
      const auto feeds = session->all<canonical::Feed>();
      ASSERT_EQ(feeds.size(), plain.size()) << orientation;
      for (std::size_t i = 0; i < feeds.size(); ++i) {
        const bool beside = i + 1 < feeds.size();  // the last one leads out to the programmed point
        EXPECT_NEAR(feeds[i].target[0] - plain[i].target[0], beside ? x : 0, 1e-12)
            << orientation << " " << i;
        EXPECT_NEAR(feeds[i].target[2] - plain[i].target[2], beside ? z : 0, 1e-12)
            << orientation << " " << i;
      }
      const auto round = session->all<canonical::Arc>();
      ASSERT_EQ(round.size(), arcs.size());
      for (std::size_t i = 0; i < round.size(); ++i) {
        EXPECT_NEAR(round[i].centre_mm[0] - arcs[i].centre_mm[0], x, 1e-12) << orientation;
        EXPECT_NEAR(round[i].centre_mm[2] - arcs[i].centre_mm[2], z, 1e-12) << orientation;
      }
    }
  }
}

TEST(Cutter, ATextMayEndWithoutG40) {
  Interpreter interpreter;
  JobReader reader(interpreter);
  CommandBuffer commands;
  ASSERT_TRUE(reader.read("F600\nG41.1 D6 G1 X20\nX40\n", commands));
  EXPECT_TRUE(interpreter.compensates());
  EXPECT_NE(interpreter.modal_codes().find("G41"), std::string::npos);
  ASSERT_TRUE(reader.finish(commands));
  ASSERT_EQ(commands.size(), 4U);
  EXPECT_EQ(canonical::to_text(commands[2]), "3 feed machine x40 y3 z0 a0 c0 e0 f10");
  // The next program begins where the tool is.
  commands.clear();
  ASSERT_TRUE(interpreter.execute("G0 Z5", 4, commands));
  EXPECT_EQ(canonical::to_text(commands.back()), "4 traverse machine x40 y3 z5 a0 c0 e0");
}

TEST(Cutter, ACurveOfShortLinesGetsNoArcsAtItsCorners) {
  for (const char* side : {"G41.1", "G42.1"}) {
    Session session;
    session.must("F600\nG0 X30 Y-20\n" + std::string(side) + " D10 G1 Y0");
    constexpr int kLines = 720;
    for (int i = 1; i <= kLines; ++i)
      session.must("X" + number(30 * std::cos(i * 2 * kPi / kLines)) + " Y" +
                   number(30 * std::sin(i * 2 * kPi / kLines)));
    session.must("G40 G1 Y30");
    EXPECT_TRUE(session.all<canonical::Arc>().empty()) << side;
    const auto moves = session.all<canonical::Feed>();
    ASSERT_EQ(moves.size(), kLines + 2U);
    for (std::size_t i = 1; i + 2 < moves.size(); ++i)
      EXPECT_NEAR(std::hypot(moves[i].target[0], moves[i].target[1]), side[2] == '1' ? 25 : 35, 2e-3);
  }
}

TEST(Cutter, ATiltedPlaneIsCompensatedInItself) {
  const std::string path =
      "F600\nG0 X0 Y0 Z5\nG41.1 D4 G1 X10 Y10 Z-1\nX40\nG2 X50 Y0 J-10\nG1 Y-20 Z-2\nX0\nG40 G1 X-10 Y-30\n";
  Session flat, tilted;
  flat.must("G1 F600\n" + path);
  tilted.must("G68.2 X5 Y6 Z7 I20 J15 K-30\nG53.1\n" + path);
  const ModalState& m = tilted.interpreter.state().modal;
  const auto a = flat.all<canonical::Feed>(), b = tilted.all<canonical::Feed>();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double expected = m.tilt_origin_mm[axis];
      for (std::size_t k = 0; k < 3; ++k) expected += m.tilt[axis][k] * a[i].target[k];
      EXPECT_NEAR(b[i].target[axis], expected, 1e-9) << i;
    }
}

TEST(Cutter, WhatAsksAndStopsIsNotHeldBack) {
  Session session;
  session.must("F600\nG41.1 D6 G1 X20\nX40\n");
  const std::size_t size = session.commands.size();
  session.must("M8\nG4 P1\nM106 S255");
  EXPECT_EQ(session.commands.size(), size);
  session.must("M112");
  EXPECT_EQ(session.texts(size), std::vector<std::string>{"7 emergency_stop"});
}

TEST(Cutter, WhatIsHeldBackIsBounded) {
  Session session;
  session.must("F600\nG41.1 D6 G1 X20");
  std::string error;
  for (int i = 0; i < 2000 && error.empty(); ++i) error = session.run(i % 2 == 0 ? "Z1" : "Z0");
  EXPECT_NE(error.find("more than 1000 lines without a move in the plane"), std::string::npos) << error;
}

}  // namespace
}  // namespace kinebus::gcode
