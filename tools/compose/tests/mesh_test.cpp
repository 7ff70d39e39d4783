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

TEST(MedialAxis, OfALeaningPrismIsItsEdgeWhicheverWayItIsLayered) {
  auto [points, polygons] = cube();
  // 10 mm high, its top moved by 7 and 2 mm; then far from the origin.
  for (Vector& p : points) p += Vector(0.7 * p[2] + 50, 0.2 * p[2] - 30, 80);
  const auto [mesh, repair] = close_mesh(points, polygons, "prism");
  const Vector edge = Vector(0.7, 0.2, 1).normalized(), up(0, 0, 1);
  EXPECT_NEAR(angle_to_medial_axis(mesh, up), std::acos(edge.dot(up)), 1e-9);
  // Square to the edge every section of the middle is the same: up to its ends, which are cut level.
  auto [tall, sides] = cube();
  for (Vector& p : tall) p = Vector(p[0] + 7 * p[2], p[1] + 2 * p[2], 10 * p[2]);
  EXPECT_NEAR(angle_to_medial_axis(close_mesh(tall, sides, "tall").first, edge), 0, 1e-9);
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
