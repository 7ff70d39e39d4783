#include "gui/scene/printed_body.hpp"

#include <gtest/gtest.h>

#include <string>

#include "gui/scene/machine_figure.hpp"
#include "gui/scene/path_reader.hpp"

namespace kinebus::gui {
namespace {

std::shared_ptr<const ToolPath> path_of(const std::string& job) {
  PathReader reader;
  reader.add(job);
  return std::make_shared<const ToolPath>(reader.finish());
}

/// A wall along X at y = 0, from x = 0 to 40, as high as `layers` layers of 0.5 mm.
std::string wall(int layers) {
  std::string job = "G21 G90\nM83\n";
  for (int i = 1; i <= layers; ++i) {
    job += "G0 X0 Y0 Z" + std::to_string(0.5 * i) + "\n";
    job += "G1 X40 E2 F1200\n";
  }
  return job;
}

MachineModel cartesian() {
  MachineModel model;
  model.kind = MachineModel::Kind::kCartesian;
  CartesianGeometry geometry;
  geometry.x_mm = geometry.y_mm = {-100, 100};
  geometry.z_mm = {0, 200};
  BodiesDescription described;
  described.fixed.push_back({"clamp", {45, -10, 0}, {60, 10, 100}});
  model.solid = bodies::make_model(geometry, described);
  model.watched = true;
  return model;
}

TEST(PrintedBody, HasWhatIsExtrudedUpToTheVertexAndNoTravel) {
  const auto path = path_of(wall(20));
  PrintedBody body;
  EXPECT_TRUE(body.follow(path, static_cast<std::uint32_t>(path->vertex_at_line(3))));
  EXPECT_TRUE(body.empty()) << "the way to where it begins is none";
  // Lines 3 and 4 make the first layer.
  EXPECT_TRUE(body.follow(path, static_cast<std::uint32_t>(path->vertex_at_line(5))));
  EXPECT_FLOAT_EQ(body.bounds_mm().low_mm[0], 0);
  EXPECT_FLOAT_EQ(body.bounds_mm().high_mm[0], 40);
  EXPECT_FLOAT_EQ(body.bounds_mm().high_mm[2], 0.5F);
  EXPECT_TRUE(body.follow(path, UINT32_MAX));
  EXPECT_FLOAT_EQ(body.bounds_mm().high_mm[2], 10);
  // The job is begun anew.
  EXPECT_TRUE(body.follow(path, static_cast<std::uint32_t>(path->vertex_at_line(5))));
  EXPECT_FLOAT_EQ(body.bounds_mm().high_mm[2], 0.5F);
}

TEST(PrintedBody, GrowsByNoMoreThanIsAskedForAtOnce) {
  const auto path = path_of(wall(50));
  PrintedBody body, whole;
  int calls = 1;
  while (!body.follow(path, UINT32_MAX, 7)) ++calls;
  EXPECT_EQ(calls, static_cast<int>((path->size() + 6) / 7));
  EXPECT_TRUE(whole.follow(path, UINT32_MAX));
  EXPECT_EQ(body.bounds_mm().high_mm, whole.bounds_mm().high_mm);
}

TEST(PrintedBody, OfAJobThatCutsThereIsNone) {
  const auto path = path_of("G21 G90\nG0 X0 Y0 Z1\nG1 X40 F1200\n");
  PrintedBody body;
  EXPECT_TRUE(body.follow(path, UINT32_MAX));
  EXPECT_TRUE(body.empty());
}

TEST(PrintedBody, BodiesThatComeCloseAreColoured) {
  const MachineModel model = cartesian();
  const auto path = path_of(wall(160));  // 80 mm high, ends 5 mm beside the clamp
  PrintedBody body;
  ASSERT_TRUE(body.follow(path, UINT32_MAX));
  const auto near_at = [&](double x_mm, double z_mm) {
    const MachineFigure figure = pose_machine(model, {{x_mm, 0, z_mm}, 0, 0}, false, &body);
    std::size_t red = 0;
    for (const FigurePart& part : figure.parts) red += part.finish == Finish::kNear ? 1 : 0;
    EXPECT_EQ(red > 0, figure.close_to_print.has_value());
    return figure.close_to_print;
  };
  // The clamp must be 2 mm away, and is 4.75: less than 3 more.
  const auto clamp = near_at(-90, 150);
  ASSERT_TRUE(clamp);
  EXPECT_EQ(model.solid->name(clamp->body), "clamp");
  EXPECT_NEAR(clamp->mm, 4.75, 0.01);
  // The holder, 40 mm above the tip, 1 mm above the part: what has least left.
  const auto holder = near_at(20, 41.25);
  ASSERT_TRUE(holder);
  EXPECT_EQ(holder->body.kind, bodies::BodyKind::kHolder);
  EXPECT_NEAR(holder->mm, 1, 0.01);
  // Printing its top: the holder is as far as the tool is long.
  ASSERT_TRUE(near_at(20, 80));
  EXPECT_EQ(near_at(20, 80)->body.kind, bodies::BodyKind::kFixed);
}

}  // namespace
}  // namespace kinebus::gui
