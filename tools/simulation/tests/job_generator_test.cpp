#include "tools/simulation/tests/simulated_job.hpp"

namespace kinebus {
namespace {

TEST(JobGenerator, WritesTheSameTextEveryTime) {
  for (const JobKind& kind : job_kinds())
    EXPECT_EQ(generated_job(kind.name, 300), generated_job(kind.name, 300)) << kind.name;
}

TEST(JobGenerator, BenchmarkJobsHaveTheLinesThatTheyClaim) {
  for (const JobKind& kind : job_kinds()) {
    const std::string text = generated_job(kind.name, kind.default_lines);
    const auto lines = std::count(text.begin(), text.end(), '\n');
    EXPECT_GE(lines, kind.default_lines) << kind.name;
    EXPECT_LE(static_cast<double>(lines), 1.05 * kind.default_lines + 200) << kind.name;
  }
}

}  // namespace
}  // namespace kinebus
