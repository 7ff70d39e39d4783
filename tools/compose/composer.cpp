#include "tools/compose/composer.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tools/compose/medial_axis.hpp"
#include "tools/compose/support.hpp"

namespace kinebus::compose {
namespace {

constexpr double kDeg = 180 / std::numbers::pi;

TriangleMesh placed(TriangleMesh mesh, bool keep_position) {
  const Box box = bounds(mesh);
  if (keep_position) {
    if (box.low[2] < -0.01) throw std::runtime_error("the part reaches below the table (z < 0)");
    return mesh;
  }
  const Vector shift(-(box.low[0] + box.high[0]) / 2, -(box.low[1] + box.high[1]) / 2, -box.low[2]);
  for (Vector& p : mesh.points) p += shift;
  return mesh;
}

SupportComparison with_support(const Slicer& slicer, const TriangleMesh& part, const ComposeOptions& options,
                               const MachineDescription& machine) {
  SupportComparison out;
  const JoinPiece plain{"uncut", {}, read_sliced(slicer.slice(part, "uncut"), "uncut.gcode"), bounds(part)};
  const JoinPiece supported{"uncut-support",
                            {},
                            read_sliced(slicer.slice(part, "uncut-support", true), "uncut-support.gcode"),
                            bounds(part)};
  out.support_filament_mm = std::max(0.0, supported.gcode.filament_mm - plain.gcode.filament_mm);
  const double radius_mm = machine.gcode.filament_diameter_mm / 2;
  out.support_mm3 = out.support_filament_mm * std::numbers::pi * radius_mm * radius_mm;
  ProblemList problems;
  out.time_s = planned_time_s(join({supported}, options.join).text, machine, problems);
  out.unsupported_time_s = planned_time_s(join({plain}, options.join).text, machine, problems);
  return out;
}

}  // namespace

Composed compose(const TriangleMesh& given, const ComposeOptions& options,
                 const MachineDescription& machine) {
  Composed out;
  const TriangleMesh part = placed(given, options.keep_position);
  const Solid solid{part, {Vector(0, 0, 1), 0}};
  const auto step = [&](const std::string& words) {
    if (options.on_step) options.on_step(words);
  };
  step("looking for arms and cuts");
  const std::vector<Solid> pieces = options.planes.empty()
                                        ? decompose(solid, options.decompose)
                                        : decompose(solid, options.planes, options.decompose);
  SlicerOptions sliced = options.slicer;
  sliced.filament_diameter_mm = machine.gcode.filament_diameter_mm;
  const Slicer slicer(sliced, options.work_folder);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Solid& piece = pieces[i];
    const std::string name = fmt::format("piece-{}", i + 1);
    step(fmt::format("slicing piece {} of {}", i + 1, pieces.size()));
    JoinPiece joined{name, frame_of(piece), {}, bounds(piece.mesh)};
    joined.gcode = read_sliced(slicer.slice(in_frame(piece.mesh, joined.frame), name), name + ".gcode");
    const Vector n = joined.frame.normal();
    out.pieces.push_back({name,
                          joined.frame.j_deg,
                          std::atan2(n[1], n[0]) * kDeg,
                          volume_mm3(piece.mesh),
                          overhang_mm2(piece, options.decompose.max_overhang_rad),
                          unheld_mm2(piece, options.decompose.max_overhang_rad),
                          joined.gcode.filament_mm,
                          joined.gcode.layers,
                          {},
                          {}});
    if (const MedialAxis axis = medial_axis(part, piece.mesh, n); axis.of_arm) {
      PieceReport& report = out.pieces.back();
      const double off = std::atan2(axis.along.cross(n).norm(), axis.along.dot(n));
      const double leans = std::atan2(std::hypot(axis.along[0], axis.along[1]), axis.along[2]);
      report.layers_off_square_deg = off * kDeg;
      report.arm_leans_deg = leans * kDeg;
      report.tilted_to_limit = leans > options.decompose.max_tilt_rad + 0.5 / kDeg &&
                               joined.frame.j_deg / kDeg > options.decompose.max_tilt_rad - 0.5 / kDeg;
    }
    out.joined.push_back(std::move(joined));
    out.meshes.push_back(piece.mesh);
  }
  step("joining and checking");
  out.job = join(out.joined, options.join);
  out.verification = verify(out.job, out.joined, out.meshes, machine, options.sweep);
  if (options.compare_support) {
    step("slicing the uncut part with support");
    out.support = with_support(slicer, part, options, machine);
  }
  return out;
}

}  // namespace kinebus::compose
