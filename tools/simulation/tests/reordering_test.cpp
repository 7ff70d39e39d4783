// An adapter that changes the order of frames (gs_usb before Linux 6.6): a print of ten minutes does not
// stop, and the tool goes the same way.

#include <fmt/format.h>

#include "tools/simulation/tests/simulated_job.hpp"

namespace kinebus {
namespace {

struct Outcome {
  SimulationReport report;
  int stops = 0;
};

Outcome print_through(int window) {
  // Less would be over before ten minutes are.
  static const std::string kTenMinutes = generated_job("print", 7000);
  Outcome outcome;
  SimulateOptions options;
  options.reorder = window;
  bool runs = false;
  options.operate = [&](Gateway& gateway, double) {
    const MachineState state = gateway.state();
    const bool stopped = state == MachineState::kStopping || state == MachineState::kStopped ||
                         state == MachineState::kHeld || state == MachineState::kAlarm;
    if (runs && stopped) ++outcome.stops;
    runs = !stopped;
  };
  outcome.report = simulate_text(kTenMinutes, 1, options);
  return outcome;
}

TEST(Reordering, APrintOfTenMinutesThroughAnAdapterThatReordersNeverStops) {
  const SimulationReport plain = print_through(1).report;
  EXPECT_GT(plain.job_time_s, 600);
  EXPECT_EQ(plain.records_out_of_sequence, 0u);
  for (const int window : {2, 3, 4}) {
    const Outcome outcome = print_through(window);
    const SimulationReport& report = outcome.report;
    fmt::print(
        "window {}: {} records out of order on the bus, {} stops, tool {:.3f} um from the plan ({:.3f} in "
        "order), path {:.3f} ({:.3f})\n",
        window, report.records_out_of_sequence, outcome.stops, report.max_tracking_error_um,
        plain.max_tracking_error_um, report.max_path_error_um, plain.max_path_error_um);
    SimulationReport bounded = report;
    bounded.records_out_of_sequence = 0;
    expect_within_bounds(bounded);
    EXPECT_GT(report.records_out_of_sequence, 20u) << "the adapter does what it is here for";
    EXPECT_EQ(outcome.stops, 0);
    EXPECT_NEAR(report.max_path_error_um, plain.max_path_error_um, 0.5);
    // A run begins at the status that confirms enough of it; those are 100 ms apart, and one may come
    // earlier.
    EXPECT_LE(report.job_time_s, plain.job_time_s + 0.01);
    EXPECT_GE(report.job_time_s, plain.job_time_s - 0.11);
  }
}

}  // namespace
}  // namespace kinebus
