#pragma once
// One job on the whole simulated machine, with all checkers: the engine of `kinebus simulate`.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "gateway/jobs/byte_source.hpp"
#include "tools/simulation/bead_reference.hpp"
#include "tools/simulation/flexible_frame.hpp"
#include "tools/simulation/plot.hpp"
#include "tools/simulation/report.hpp"
#include "tools/simulation/ringing_plot.hpp"
#include "tools/simulation/simulation.hpp"

namespace kinebus {

/// The tool swings on its frame.
struct FlexiblePhysics {
  std::array<FlexibleFrame::Modes, 3> truth{};
  /// The job's text once more, for how far the plan leaves it; may be nothing.
  std::shared_ptr<ByteSource> text;
  RingingTrace* trace = nullptr;  ///< filled along the way, its first kMostTraced points
};

/// Melt in the nozzle, and what the job asks for.
struct NozzlePhysics {
  Nozzle::Truth truth;
  std::shared_ptr<const BeadReference> reference;
};

/// Twenty minutes.
inline constexpr std::size_t kMostTraced = 1'200'000;
/// Both runs of simulate_flexible.
struct RingingTraces {
  RingingTrace unshaped, shaped;  ///< shaped: empty where nothing is
};

struct SimulateOptions {
  SimulationOptions simulation;
  std::optional<FlexiblePhysics> flexible;  ///< none: a rigid machine
  std::optional<NozzlePhysics> nozzle;      ///< none: nobody looks at beads
  /// Nodes of another make in the place of these virtual ones (firmware images on emulated boards).
  std::function<std::unique_ptr<NodeMachine>(const std::vector<VirtualNodeOptions>&)> make_nodes;
  int reorder = 1;     ///< an adapter changes the order of up to so many frames, either way (ReorderingNodes)
  double limit_s = 0;  ///< stop measuring after so much job time; 0: the whole job
  PlotData* plot = nullptr;          ///< filled along the way
  RingingTraces* ringing = nullptr;  ///< the same, by simulate_flexible
  std::function<void(double progress, double job_s)> on_progress;
  /// Every sample of the job, with the distance from the programmed path and its line there.
  std::function<void(const Sample&, double path_um, std::uint32_t line)> on_sample;
  /// Called every millisecond of the job: may hold, resume, override, stop. A held job then is not the end.
  std::function<void(Gateway&, double job_s)> operate;
  std::function<void(BusTime, const CanFrame&)> on_frame;  ///< every frame on the bus, from power-up on
};

/// Brings the machine up, homes it, goes to the bed reference, runs the job and measures. `job` and
/// `same_job` are two readers of the same text: one for the machine, one for the checker.
SimulationReport simulate(const MachineDescription& machine, std::unique_ptr<ByteSource> job,
                          ByteSource& same_job, const SimulateOptions& options);

inline constexpr double kNozzleError = 0.10;

/// The same on a flexible frame whose parameters are off by `error` from what `machine` states, beside a run
/// of the same job, machine and truth without shaping: SimulationReport::vibration has both and their ratios.
/// Beads are laid by a nozzle whose melt is off by kNozzleError from what `machine` states, or by that of
/// `options`. `open`: the job's
/// text from its beginning, each time it is asked for.
SimulationReport simulate_flexible(const MachineDescription& machine,
                                   const std::function<std::unique_ptr<ByteSource>()>& open,
                                   const FlexibleFrame::Error& error, SimulateOptions options);

}  // namespace kinebus
