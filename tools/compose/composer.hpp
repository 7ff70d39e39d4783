#pragma once
// The whole chain: part -> pieces -> slices -> one five-axis job -> verified.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/compose/decompose.hpp"
#include "tools/compose/joiner.hpp"
#include "tools/compose/mesh_kernel.hpp"
#include "tools/compose/slicer.hpp"
#include "tools/compose/verify.hpp"

namespace kinebus::compose {

struct ComposeOptions {
  DecomposeOptions decompose;
  SlicerOptions slicer;
  JoinOptions join;
  SweepOptions sweep;
  std::vector<Plane> planes;    ///< given cuts; empty: found
  bool keep_position = false;   ///< else the part is centred on the table and stood on it
  bool compare_support = true;  ///< also slice the uncut part with support, to tell what was saved
  std::string work_folder;      ///< for meshes and G-code of the pieces
  std::function<void(const std::string& step)> on_step;  ///< what is done now, in a few words
};

struct PieceReport {
  std::string name;
  double tilt_deg = 0, azimuth_deg = 0, volume_mm3 = 0, overhang_mm2 = 0, unheld_mm2 = 0, filament_mm = 0;
  int layers = 0;
  /// Measured on the meshes (medial_axis.hpp): the layers' normal from the arm's axis, and how far that leans
  /// from z. nullopt: the piece is no arm.
  std::optional<double> layers_off_square_deg, arm_leans_deg;
  /// The arm leans farther than the machine tilts, which is used up.
  bool tilted_to_limit = false;
};

/// What the uncut part would have needed.
struct SupportComparison {
  double support_filament_mm = 0;  ///< more than without support
  double support_mm3 = 0;
  double time_s = 0;  ///< of the job with support, by the same planner
  /// Of the uncut part printed as if nothing hung, which cannot be: about the least that cutting can reach.
  double unsupported_time_s = 0;
};

struct Composed {
  Repair repair;
  std::vector<PieceReport> pieces;
  std::vector<JoinPiece> joined;
  std::vector<TriangleMesh> meshes;  ///< of the pieces, part coordinates
  JoinedJob job;
  Verification verification;
  std::optional<SupportComparison> support;
};

/// Throws std::runtime_error with place and reason.
Composed compose(const TriangleMesh& part, const ComposeOptions& options, const MachineDescription& machine);

}  // namespace kinebus::compose
