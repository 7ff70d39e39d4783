#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "tools/compose/decompose.hpp"
#include "tools/compose/example_parts.hpp"
#include "tools/compose/medial_axis.hpp"
#include "tools/compose/mesh_kernel.hpp"
#include "tools/compose/nozzle.hpp"
#include "tools/compose/piece_frame.hpp"
#include "tools/compose/section.hpp"
#include "tools/compose/support.hpp"

namespace kinebus::compose {
namespace {

std::pair<std::vector<Vector>, std::vector<std::vector<std::size_t>>> cube() {
  std::vector<Vector> points;
  for (int i = 0; i < 8; ++i) points.emplace_back((i & 1) * 10.0, ((i >> 1) & 1) * 10.0, (i >> 2) * 10.0);
  return {points, {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
}

TEST(Mesh, ACubeWithAFaceMissingIsClosed) {
  auto [points, polygons] = cube();
  polygons.pop_back();
  const auto [mesh, repair] = close_mesh(points, polygons, "cube");
  EXPECT_EQ(repair.holes_filled, 1);
  EXPECT_NEAR(volume_mm3(mesh), 1000, 1e-9);
}

/// 10 x 10 mm, 80 mm high, its top moved sideways: a column that leans along `leaning_edge()`, cut level.
TriangleMesh leaning_column(const Vector& shift) {
  auto [points, polygons] = cube();
  for (Vector& p : points) p = Vector(p[0] + 5.6 * p[2], p[1] + 1.6 * p[2], 8 * p[2]) + shift;
  return close_mesh(points, polygons, "column").first;
}

Vector leaning_edge() {
  return Vector(0.7, 0.2, 1).normalized();
}

TEST(MedialAxis, OfALeaningColumnIsItsEdgeWhicheverWayItIsLayered) {
  const TriangleMesh column = leaning_column({50, -30, 80});
  const Vector up(0, 0, 1), across = Vector(-0.2, 0.1, 1).normalized();
  for (const Vector& normal : {up, leaning_edge(), across}) {
    const MedialAxis axis = medial_axis(column, column, normal);
    EXPECT_TRUE(axis.of_arm);
    EXPECT_NEAR(axis.along.cross(leaning_edge()).norm(), 0, 1e-4) << normal.transpose();
  }
  auto [points, polygons] = cube();
  for (Vector& p : points) p = Vector(6 * p[0], 8 * p[1], p[2]);
  const TriangleMesh plate = close_mesh(points, polygons, "plate").first;
  EXPECT_FALSE(medial_axis(plate, plate, Vector(1, 0, 0)).of_arm);
}

TEST(Section, TheSmallestThroughAPointStandsSquareToTheArm) {
  const TriangleMesh column = leaning_column({0, 0, 0});
  const Sections sections(column);
  const Vector inside = Vector(33, 13, 40);
  const auto found = sections.smallest(inside);
  ASSERT_TRUE(found);
  EXPECT_LT(found->normal.cross(leaning_edge()).norm(), 0.003);
  // A level section is 100 mm2; square to the edge it is smaller by the lean.
  EXPECT_NEAR(found->section.area_mm2, 100 * leaning_edge()[2], 0.01);
  EXPECT_EQ(found->section.parts, 1);
  EXPECT_FALSE(sections.at({Vector(0, 0, 1), 40}, Vector(0, 0, 40))) << "beside it";
  const TriangleMesh t = example_part("t");
  const auto level = Sections(t).at({Vector(0, 0, 1), 10}, Vector(0, 0, 10));
  ASSERT_TRUE(level);
  EXPECT_NEAR(level->area_mm2, 16 * 14, 1e-6);
  EXPECT_NEAR(level->extent_mm, std::hypot(16, 14), 1e-6);
}

TEST(Decompose, LayersOfAnArmLieSquareToItAsFarAsTheTableTilts) {
  const Solid bent{example_part("two-piece"), {}};
  const double lean = 50 * std::numbers::pi / 180;  // of its upper half
  const Vector arm(std::sin(lean), 0, std::cos(lean));
  for (const double most_deg : {30.0, 45.0, 60.0}) {
    DecomposeOptions options;
    options.max_tilt_rad = most_deg * std::numbers::pi / 180;
    const std::vector<Solid> pieces = decompose(bent, options);
    const Vector n = pieces.back().base.normal;
    const double off_deg = std::acos(std::min(1.0, n.dot(arm))) * 180 / std::numbers::pi;
    EXPECT_NEAR(off_deg, std::max(0.0, 50 - most_deg), 0.6) << "tilt " << most_deg;
  }
  // The hook bends over in a quarter circle: in several pieces, each with the arc's slope in its middle.
  std::vector<double> tilts_deg;
  for (const Solid& piece : decompose({example_part("hook"), {}}, DecomposeOptions{}))
    tilts_deg.push_back(std::acos(std::min(1.0, piece.base.normal[2])) * 180 / std::numbers::pi);
  ASSERT_EQ(tilts_deg.size(), 4u);
  EXPECT_NEAR(tilts_deg[0], 0, 1e-6);
  EXPECT_NEAR(tilts_deg[1], 23, 3);
  EXPECT_NEAR(tilts_deg[2], 45, 1e-6) << "level from here on: as far as the table tilts";
  EXPECT_NEAR(tilts_deg[3], 0, 1) << "the lip stands upright";
}

TEST(Mesh, AMeshTurnedInsideOutIsTurnedBack) {
  auto [points, polygons] = cube();
  for (auto& polygon : polygons) std::reverse(polygon.begin(), polygon.end());
  const auto [mesh, repair] = close_mesh(points, polygons, "cube");
  EXPECT_NEAR(volume_mm3(mesh), 1000, 1e-9);
}

TEST(Mesh, ACutClosesBothHalvesAndLosesNoVolume) {
  const TriangleMesh part = example_part("hook");
  const double whole = volume_mm3(part);
  for (const double height : {10.0, 20.0, 30.0}) {
    const Halves halves = cut(part, {Vector(1, 0.3, 1).normalized(), height});
    EXPECT_NEAR(volume_mm3(halves.below) + volume_mm3(halves.above), whole, 1e-6 * whole);
  }
}

TEST(Mesh, FilesThatAreNoMeshAreRefusedByName) {
  const std::string path = testing::TempDir() + "/not-a-mesh.stl";
  std::ofstream(path) << "solid nothing\nendsolid nothing\n";
  try {
    read_mesh(path);
    FAIL() << "an empty mesh was taken";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
  }
  EXPECT_THROW(read_mesh("part.step"), std::runtime_error);
}

TEST(Decompose, EveryExamplePartPrintsWithoutOverhang) {
  const DecomposeOptions options;
  for (const std::string& name : example_names()) {
    const TriangleMesh part = example_part(name);
    const Solid solid{part, {}};
    EXPECT_GT(overhang_mm2(solid, options.max_overhang_rad), 50) << name << " is no test: it has no overhang";
    double volume = 0;
    const std::vector<Solid> pieces = decompose(solid, options);
    EXPECT_GE(pieces.size(), 2u) << name;
    EXPECT_LE(pieces.size(), 10u) << name;
    for (const Solid& piece : pieces) {
      EXPECT_LE(overhang_mm2(piece, options.max_overhang_rad), options.allowed_mm2) << name;
      EXPECT_LE(unheld_mm2(piece, options.max_overhang_rad), options.allowed_mm2) << name;
      EXPECT_LE(std::acos(piece.base.normal[2]), options.max_tilt_rad + 1e-9) << name;
      volume += volume_mm3(piece.mesh);
    }
    EXPECT_NEAR(volume, volume_mm3(part), 1e-3 * volume) << name << ": the pieces are not the whole part";
  }
}

TEST(LayeredBody, AnEdgeThatBeginsInTheAirIsFound) {
  // A cube on its edge: its faces lean only 45 degrees, but the edge itself stands on nothing.
  auto [points, polygons] = cube();
  for (Vector& p : points)
    p = Vector((p[0] - p[2]) / std::numbers::sqrt2, p[1], (p[0] + p[2]) / std::numbers::sqrt2);
  const Solid edge{close_mesh(points, polygons, "cube").first, {Vector(0, 0, 1), -1}};
  const double limit = std::numbers::pi / 4;
  EXPECT_EQ(overhang_mm2(edge, limit), 0);
  EXPECT_GT(unheld_mm2(edge, limit), 5);
  const Solid flat{close_mesh(cube().first, cube().second, "cube").first, {}};
  EXPECT_EQ(unheld_mm2(flat, limit), 0);
}

TEST(Decompose, WhatIsPrintedBeforeAPieceOfTheStandingBodyLiesBelowItsFace) {
  const std::vector<Solid> pieces = decompose({example_part("t"), {}}, DecomposeOptions{});
  ASSERT_EQ(pieces.size(), 3u);
  for (std::size_t i = 1; i < pieces.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      for (const Vector& p : pieces[k].mesh.points) EXPECT_LE(pieces[i].base.over(p), 1e-6);
}

TEST(Decompose, APlaneThatCutsNothingIsRefused) {
  const Solid solid{example_part("t"), {}};
  EXPECT_THROW(decompose(solid, {Plane{Vector(0, 0, 1), 500}}, DecomposeOptions{}), std::runtime_error);
  EXPECT_THROW(decompose(solid, {Plane{Vector(1, 0, 0), 9}}, DecomposeOptions{}), std::runtime_error);
}

TEST(PieceFrame, ItsAnglesGiveItsAxes) {
  Solid piece{example_part("t"), {Vector(0.5, -0.3, 0.8).normalized(), 12}};
  const PieceFrame frame = frame_of(piece);
  EXPECT_LT((frame.normal() - piece.base.normal).norm(), 1e-12);
  EXPECT_NEAR(piece.base.over(frame.origin), 0, 1e-9);
  EXPECT_LT((frame.axes.transpose() * frame.axes - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_GT(frame.axes(0, 0), 0.7) << "x stays near the part's x";
  const Vector q(3, 4, 5);
  EXPECT_LT((frame.to_part(frame.to_piece(q)) - q).norm(), 1e-12);
}

TEST(Nozzle, MeetsWhatIsBesideItAndHigherThanItsTip) {
  auto [points, polygons] = cube();
  const TriangleMesh block = close_mesh(points, polygons, "cube").first;
  const Nozzle nozzle;
  const Obstacles there({&block}, 0, Vector(0, 0, 1), 0);
  EXPECT_GT(there.overlap_mm(nozzle, Vector(11, 5, 0.2)), 0) << "1 mm beside a wall of 10 mm";
  EXPECT_LE(there.overlap_mm(nozzle, Vector(40, 5, 0.2)), 0);
  EXPECT_LE(there.overlap_mm(nozzle, Vector(5, 5, 10.01)), 0) << "on top of it";
  const Obstacles tilted({}, 100, Vector(0, std::sin(0.6), std::cos(0.6)), 0);
  EXPECT_GT(tilted.overlap_mm(nozzle, Vector(0, -20, 1)), 0) << "the tilted table rises beside the tip";
  EXPECT_LE(tilted.overlap_mm(nozzle, Vector(0, 0, 60)), 0);
}

}  // namespace
}  // namespace kinebus::compose
