#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include "tools/drawing/chart.hpp"
#include "tools/drawing/colour.hpp"
#include "tools/drawing/faces.hpp"

namespace kinebus::drawing {
namespace {

std::size_t count(const std::string& text, std::string_view what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

TEST(Document, WordsAreEscaped) {
  Document d(100, 50);
  d.heading(10, "a<b> & 'c'", "\"d\"\x01");
  const std::string svg = d.svg();
  EXPECT_NE(svg.find(">a&lt;b&gt; &amp; &#39;c&#39;</text>"), std::string::npos) << svg;
  EXPECT_NE(svg.find(">&quot;d&quot; </text>"), std::string::npos) << svg;
}

TEST(Document, ItemsOfASubtitleStandApart) {
  Document d(100, 50);
  d.heading(10, "job", "two words   5 lines  seed 1 ");
  EXPECT_NE(d.svg().find(">two words \u00b7 5 lines \u00b7 seed 1 </text>"), std::string::npos) << d.svg();
}

TEST(Document, NumbersAreShortAndNeverMinusZero) {
  Document d(100, 50);
  d.line({-0.04, 12.0}, {-0.06, 1.25}, {.width = 0.55});
  const std::string svg = d.svg();
  EXPECT_NE(svg.find("<line x1='0' y1='12' x2='-0.1' y2='1.3' stroke-width='0.55'/>"), std::string::npos)
      << svg;
}

TEST(Document, WhatIsNoNumberLeavesAPictureThatCanBeRead) {
  Document d(100, 50);
  d.circle({std::nan(""), std::numeric_limits<double>::infinity()}, 1, {});
  const std::string svg = d.svg();
  EXPECT_NE(svg.find("<circle cx='0' cy='10000000' r='1'/>"), std::string::npos) << svg;
}

TEST(Document, GroupsCloseInTheirOrderAndNamesAreDefined) {
  Document d(100, 50);
  constexpr GradientStop kStops[] = {{0, "black"}, {1, "white"}};
  const std::string fill = d.gradient(kStops);
  {
    const auto outer = d.clipped({0, 0, 10, 10}, 2);
    const auto inner = d.group({.fill = fill});
    d.circle({5, 5}, 3, {});
  }
  d.rectangle({1, 2, 3, 4}, {.fill = "red"});
  const std::string svg = d.svg();
  EXPECT_EQ(count(svg, "<g"), 2u);
  EXPECT_EQ(count(svg, "</g>"), 2u);
  EXPECT_LT(svg.rfind("</g>"), svg.find("fill='red'"));
  EXPECT_NE(svg.find("id='" + fill.substr(5, fill.size() - 6) + "'"), std::string::npos) << svg;
  EXPECT_TRUE(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
}

TEST(Chart, StepsAreRoundAndDivideIntoNoMoreThanAsked) {
  for (const auto& [range, parts, step] : std::vector<std::tuple<double, int, double>>{
           {1, 5, 0.2}, {0.2 * 5, 5, 0.2}, {100, 7, 20}, {3, 4, 1}, {0, 4, 5e-10}, {1e6, 10, 1e5}})
    EXPECT_NEAR(round_step(range, parts), step, 1e-9 * step) << range << " / " << parts;
}

TEST(Chart, TicksIncludeBothEndsAndZeroIsZero) {
  const auto at = ticks(-0.3, 0.3, 0.1);
  ASSERT_EQ(at.size(), 7u);
  std::string words;
  for (const double v : at) words += tick_words(v, 0.1) + " ";
  EXPECT_EQ(words, "-0.3 -0.2 -0.1 0 0.1 0.2 0.3 ");
  EXPECT_TRUE(ticks(1, 0, 0.5).empty());
}

TEST(Chart, ValuesLieWhereTheTicksSay) {
  const Chart chart{.area = {100, 50, 200, 80}, .x_low = 0, .x_high = 10, .y_low = -1, .y_high = 1};
  EXPECT_EQ(chart.at(5, 0).x, 200);
  EXPECT_EQ(chart.at(5, 0).y, 90);
  EXPECT_EQ(chart.at(0, 1).y, 50);
  Document d(400, 200);
  draw_frame(d, chart, {.x_step = 5, .y_step = 1, .title = "t", .x_name = "x < y", .y_unit = 1e-3});
  const std::string svg = d.svg();
  for (const char* words : {">-1000<", ">0<", ">1000<", ">5<", ">10<", ">x &lt; y<"})
    EXPECT_NE(svg.find(words), std::string::npos) << words;
}

TEST(Chart, PointsBeyondTheFrameAreDrawnOnItsEdge) {
  const Chart chart{.area = {0, 0, 100, 100}};
  Document d(100, 100);
  const std::vector<Point> values{{0.5, 7}, {0.5, -7}};
  draw_points(d, chart, values, "red");
  EXPECT_EQ(count(d.svg(), "cy='0'"), 1u);
  EXPECT_EQ(count(d.svg(), "cy='100'"), 1u);
}

TEST(Chart, TheLegendKeepsItsOrder) {
  Document d(400, 100);
  const std::vector<LegendEntry> entries{{"first", "red"}, {"second", "blue"}};
  draw_legend(d, {390, 20}, entries);
  const std::string svg = d.svg();
  const auto x_of = [&](const char* words) {
    const std::size_t end = svg.find(words), x = svg.rfind("x='", end);
    return std::stod(svg.substr(x + 3));
  };
  EXPECT_EQ(x_of(">second"), 390);
  EXPECT_LT(x_of(">first"), 390 - text_width("second", 12));
  EXPECT_EQ(text_width("µm", 10), text_width("mm", 10));
}

TEST(Colour, GrowsLighterAllTheWay) {
  double before = -1;
  for (int i = 0; i <= 20; ++i) {
    const auto c = scale_colour(i / 20.0);
    const double light = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
    EXPECT_GT(light, before);
    before = light;
  }
  EXPECT_EQ(scale_rgb(-1), "#440154");
  EXPECT_EQ(scale_rgb(2), "#fde725");
}

TEST(Faces, TheNearestIsDrawnLast) {
  Document d(10, 10);
  draw_faces(d, {{{}, 2, "#000002"}, {{}, -1, "#000001"}, {{}, 5, "#000003"}}, 1);
  const std::string svg = d.svg();
  EXPECT_LT(svg.find("#000001"), svg.find("#000002"));
  EXPECT_LT(svg.find("#000002"), svg.find("#000003"));
}

}  // namespace
}  // namespace kinebus::drawing
