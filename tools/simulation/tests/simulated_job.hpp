#pragma once
// One job on the simulated machine, and the bounds that every job must keep.

#include <gtest/gtest.h>

#include <string>

#include "tools/simulation/job_generator.hpp"
#include "tools/simulation/simulate.hpp"

namespace kinebus {

inline std::string generated_job(const std::string& kind, std::uint32_t lines) {
  std::string text;
  for (const JobKind& k : job_kinds())
    if (k.name == kind) k.write([&](std::string_view part) { text += part; }, lines);
  return text;
}

inline SimulationReport simulate_on(const MachineDescription& machine, const std::string& text,
                                    std::uint64_t seed = 1, SimulateOptions options = {}) {
  options.simulation.seed = seed;
  StringSource same(text);
  return simulate(machine, std::make_unique<StringSource>(text), same, options);
}

inline SimulationReport simulate_text(const std::string& text, std::uint64_t seed = 1,
                                      SimulateOptions options = {}) {
  return simulate_on(default_m1(), text, seed, std::move(options));
}

/// The limits of the machine and the accuracy promised. `path_um`: tracking error and blend tolerance.
/// `joint_counts`: of a motor, in its microsteps.
inline void expect_within_bounds(const SimulationReport& r, double path_um = 1.5 + 5.0,
                                 double joint_counts = 0.5) {
  const bool failed_before = ::testing::Test::HasFailure();
  EXPECT_TRUE(r.finished) << r.outcome;
  EXPECT_FALSE(r.trouble);
  EXPECT_GT(r.samples, 0u);
  EXPECT_LE(r.max_tracking_error_um, 1.5);
  EXPECT_LE(r.max_path_error_um, path_um);
  EXPECT_LE(r.max_joint_error_counts, joint_counts);
  EXPECT_LE(r.max_joint_velocity_ratio, 1.0);
  EXPECT_LE(r.max_joint_acceleration_ratio, 1.0);
  EXPECT_LE(r.max_velocity_step_ratio, 1.0);
  EXPECT_LE(r.max_node_time_skew_us, 2.0);
  EXPECT_LE(r.bus_load_peak_1s, 0.6);
  EXPECT_EQ(r.underruns, 0u);
  EXPECT_EQ(r.queue_overruns, 0u);
  EXPECT_EQ(r.records_out_of_sequence, 0u);
  if (!failed_before && ::testing::Test::HasFailure()) ADD_FAILURE() << "the whole report:\n" << to_table(r);
}

}  // namespace kinebus
