// G71, G72 and G70 by what the tool does: on stock that is as high as the start, in narrow columns.
#include "gateway/gcode/curves/turning.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "gateway/gcode/programs/job_reader.hpp"
#include "gateway/gcode/tests/golden_options.hpp"

namespace kinebus::gcode {
namespace {

constexpr double kTolerance_mm = 1e-4;
constexpr int kColumns = 400;

Curve line(Point2 from, Point2 to) {
  Curve curve;
  curve.from = from, curve.to = to;
  return curve;
}

/// A quarter of an ellipse's place taken by an arc: tangent to one of the axes at one end.
Curve arc(Point2 from, double along, double up, int turn) {
  Curve curve = line(from, {from[0] + along, from[1] + up});
  curve.arc = true;
  curve.turn = turn;
  const Point2 chord = curve.to - from, middle = (from + curve.to) * 0.5;
  const double half = length_of(chord) / 2;
  curve.radius = 1.5 * half;
  curve.centre = middle + left_of(chord) * (turn * std::sqrt(1.25) * half / length_of(chord));
  curve.sweep = 2 * std::asin(1 / 1.5);
  return curve;
}

Point2 point_of(const Curve& curve, double t) {
  if (!curve.arc) return curve.from + (curve.to - curve.from) * t;
  const Point2 r = curve.from - curve.centre;
  const double angle = curve.turn * curve.sweep * t;
  return curve.centre + r * std::cos(angle) + left_of(r) * std::sin(angle);
}

struct Part {
  std::vector<Curve> profile;  ///< the first piece comes to it
  Point2 start{};
};

/// Along +u, with pockets; the tool comes from above.
Part random_part(std::mt19937& random, bool with_pockets) {
  const auto between = [&](double a, double b) { return std::uniform_real_distribution(a, b)(random); };
  Part part;
  part.start = {-1, between(12, 16)};
  Point2 here{0, between(2, 5)};
  part.profile.push_back(line(part.start, here));
  const auto add = [&](const Curve& curve) {
    part.profile.push_back(curve);
    here = curve.to;
  };
  while (here[0] < 25) {
    const double along = between(1, 6);
    double up = between(0, 3);
    if (with_pockets && random() % 3 == 0) up = -std::min(between(0.5, 4), here[1] - 1);
    up = std::min(up, part.start[1] - 4 - here[1]);
    switch (random() % 4) {
      case 0:
        add(line(here, {here[0] + along, here[1]}));
        break;
      case 1:
        add(line(here, {here[0], here[1] + up}));
        break;
      case 2:
        if (std::abs(up) > 0.2 && std::abs(up) < along * 0.8 && along < 5 * std::abs(up)) {
          Curve curve = arc(here, along, up, random() % 2 == 0 ? 1 : -1);
          const double ahead = direction_at_start(curve)[0], behind = direction_at_end(curve)[0];
          if (ahead > 0.01 && behind > 0.01) add(curve);
          break;
        }
        [[fallthrough]];
      default:
        add(line(here, {here[0] + along, here[1] + up}));
    }
  }
  return part;
}

/// The stock's columns while moves are carried out.
class Stock {
 public:
  Stock(const Part& part) : height_(kColumns, part.start[1]), end_(part.profile.back().to[0]) {}
  double height(int column) const { return height_[static_cast<std::size_t>(column)]; }
  double place(int column) const { return end_ * (column + 0.5) / kColumns; }
  /// How deep the move cuts, at most.
  double cut(const Curve& curve) {
    double deepest = 0;
    Point2 from = curve.from;
    constexpr int kSteps = 400;
    for (int i = 1; i <= kSteps; ++i) {
      const Point2 to = point_of(curve, static_cast<double>(i) / kSteps);
      const double left = std::min(from[0], to[0]), right = std::max(from[0], to[0]);
      const int first = std::max(0, static_cast<int>(std::ceil(left / end_ * kColumns - 0.5)));
      for (int column = first; column < kColumns && place(column) <= right; ++column) {
        const double t = (place(column) - from[0]) / (to[0] - from[0]);
        double& height = height_[static_cast<std::size_t>(column)];
        const double tool = from[1] + (to[1] - from[1]) * t;
        deepest = std::max(deepest, height - tool);
        height = std::min(height, tool);
      }
      from = to;
    }
    return deepest;
  }

 private:
  std::vector<double> height_;
  double end_;
};

double profile_height(const Part& part, double along) {
  double height = 0;
  for (std::size_t i = 1; i < part.profile.size(); ++i) {
    const Curve& curve = part.profile[i];
    if (along < curve.from[0] || along > curve.to[0]) continue;
    if (!curve.arc) {
      const double wide = curve.to[0] - curve.from[0];
      if (wide > 0)
        height =
            std::max(height, curve.from[1] + (curve.to[1] - curve.from[1]) * (along - curve.from[0]) / wide);
      continue;
    }
    const double x = along - curve.centre[0];
    const double rise = std::sqrt(std::max(0.0, curve.radius * curve.radius - x * x));
    height = std::max(height, curve.centre[1] + (curve.turn > 0 ? -rise : rise));
  }
  return height;
}

TEST(Turning, NoCutIsDeeperThanAskedNoTraverseCutsAndThePartIsWhole) {
  constexpr unsigned kSeed = 20261127;
  int cut = 0, pockets = 0;
  for (unsigned seed = kSeed; seed < kSeed + 400; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const Part part = random_part(random, seed % 2 == 0);
    Turning turning;
    turning.depth_mm = std::uniform_real_distribution(0.3, 2.0)(random);
    turning.retract_mm = std::uniform_real_distribution(0.0, 1.0)(random);
    turning.allowance_mm = seed % 3 == 0 ? 0.4 : 0;
    const auto moves = turn(part.profile, part.start, turning);
    if (!moves) {
      ASSERT_GT(turning.allowance_mm, 0) << moves.error().english();
      continue;
    }
    ++cut;
    pockets += seed % 2 == 0 ? 1 : 0;
    Stock stock(part);
    Point2 here = part.start;
    for (const TurningMove& move : *moves) {
      ASSERT_NEAR(length_of(move.curve.from - here), 0, 1e-5);
      here = move.curve.to;
      ASSERT_LE(stock.cut(move.curve), (move.traverse ? 0 : turning.depth_mm) + kTolerance_mm)
          << (move.traverse ? "traverse to " : "feed to ") << here[0] << ' ' << here[1];
      for (int i = 0; i <= 50; ++i) {
        const Point2 tool = point_of(move.curve, i / 50.0);
        for (std::size_t k = 1; k < part.profile.size(); ++k) {
          if (length_of(part.profile[k].to - part.profile[k].from) < 1e-9) continue;
          ASSERT_GE(distance(line(tool, tool + Point2{1e-9, 0}), part.profile[k]),
                    turning.allowance_mm - kTolerance_mm);
        }
      }
    }
    for (int column = 0; column < kColumns; ++column) {
      const double part_mm = profile_height(part, stock.place(column));
      ASSERT_GE(stock.height(column), part_mm - 0.01) << "at " << stock.place(column);
      const double most_mm = turning.allowance_mm == 0 ? part_mm + 0.01 : part.start[1];
      ASSERT_LE(stock.height(column), most_mm) << "at " << stock.place(column);
    }
  }
  std::printf("%d of 400 parts cut, %d with pockets\n", cut, pockets);
  EXPECT_GT(cut, 280);
}

TEST(Turning, IsTheSameInEveryQuadrantAndAlongBothAxes) {
  std::mt19937 random(7);
  for (int round = 0; round < 50; ++round) {
    const Part part = random_part(random, true);
    Turning turning;
    turning.depth_mm = 0.7;
    turning.allowance_mm = 0;
    const auto plain = turn(part.profile, part.start, turning);
    ASSERT_TRUE(plain);
    for (int way = 1; way < 8; ++way) {
      const auto map = [way](Point2 p) {
        if ((way & 1) != 0) p[0] = -p[0];
        if ((way & 2) != 0) p[1] = -p[1];
        if ((way & 4) != 0) std::swap(p[0], p[1]);
        return p;
      };
      const bool mirrored = ((way & 1) != 0) != (((way & 2) != 0) != ((way & 4) != 0));
      Part other = part;
      for (Curve& curve : other.profile) {
        curve.from = map(curve.from), curve.to = map(curve.to), curve.centre = map(curve.centre);
        if (mirrored) curve.turn = -curve.turn;
      }
      turning.facing = (way & 4) != 0;
      const auto moves = turn(other.profile, map(part.start), turning);
      ASSERT_TRUE(moves);
      ASSERT_EQ(moves->size(), plain->size());
      for (std::size_t i = 0; i < moves->size(); ++i) {
        ASSERT_NEAR(length_of((*moves)[i].curve.to - map((*plain)[i].curve.to)), 0, 1e-9);
        ASSERT_EQ((*moves)[i].traverse, (*plain)[i].traverse);
      }
    }
  }
}

TEST(Turning, PocketsAreBridgedOrCutAloneAndTogetherLeaveThePart) {
  std::mt19937 random(11);
  for (int round = 0; round < 50; ++round) {
    const Part part = random_part(random, true);
    Stock stock(part);
    for (const auto what : {Turning::What::kOutside, Turning::What::kPockets}) {
      Turning turning;
      turning.what = what;
      turning.depth_mm = 0.8;
      const auto moves = turn(part.profile, part.start, turning);
      ASSERT_TRUE(moves) << moves.error().english();
      for (const TurningMove& move : *moves)
        ASSERT_LE(stock.cut(move.curve), (move.traverse ? 0 : turning.depth_mm) + kTolerance_mm)
            << "round " << round;
    }
    for (int column = 0; column < kColumns; ++column)
      ASSERT_NEAR(stock.height(column), profile_height(part, stock.place(column)), 0.01);
  }
}

TEST(Turning, FinishingKeepsItsDistanceInEachPass) {
  const std::vector<Curve> profile = {line({5, 20}, {0, 10}), line({0, 10}, {-5, 10}),
                                      line({-5, 10}, {-9, 15})};
  Turning turning;
  turning.what = Turning::What::kFinish;
  turning.allowance_mm = 1, turning.last_mm = 0.25, turning.passes = 3;
  const auto moves = turn(profile, {5, 20}, turning);
  ASSERT_TRUE(moves);
  std::vector<double> heights;
  for (const TurningMove& move : *moves)
    if (!move.traverse && std::abs(move.curve.from[1] - move.curve.to[1]) < 1e-9)
      heights.push_back(move.curve.to[1] - 10);
  ASSERT_EQ(heights.size(), 3U);
  EXPECT_NEAR(heights[0], 0.75, 1e-9);
  EXPECT_NEAR(heights[1], 0.5, 1e-9);
  EXPECT_NEAR(heights[2], 0.25, 1e-9);
}

TEST(Turning, ARefusedLineOfTheProfileAssignsNothing) {
  for (const char* wrong : {"#100=3 G1 X4 Y5", "#100=3 G4 P1", "#100=3 M0"}) {
    Interpreter interpreter(golden_options("options: spindle"));
    JobReader reader(interpreter);
    CommandBuffer commands;
    std::string text = "G18 F100\nG0 X10 Z1\no1 sub\nG0 X5\n#101=2 G1 Z-3\n";
    text.append(wrong).append("\no1 endsub\nG71 Q1 X10 Z1 I1\n");
    EXPECT_FALSE(reader.read(text, commands)) << wrong;
    EXPECT_EQ(interpreter.state().parameters.numbered[101], 2) << wrong;
    EXPECT_EQ(interpreter.state().parameters.numbered[100], 0) << wrong;
  }
}

}  // namespace
}  // namespace kinebus::gcode
