// golden/NAME.ngc gives exactly golden/NAME.canon; bad/NAME.ngc is refused as its first line says. A changed
// golden file is made with gcode_print and read before it is committed; this test writes nothing.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "gateway/gcode/canonical_text.hpp"
#include "gateway/gcode/programs/job_reader.hpp"
#include "gateway/gcode/tests/golden_options.hpp"

namespace kinebus::gcode {
namespace {

namespace fs = std::filesystem;

std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<fs::path> jobs_in(const std::string& folder) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(fs::path(GCODE_TESTS) / folder))
    if (entry.path().extension() == ".ngc") paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  return paths;
}

struct Outcome {
  std::string text;  ///< commands and notes, a line each
  std::string error;
};

Outcome run(const std::string& job) {
  Interpreter interpreter(golden_options(job));
  JobReader reader(interpreter);
  CommandBuffer commands;
  auto result = reader.read(job, commands);
  if (result) result = reader.finish(commands);
  Outcome outcome;
  for (const canonical::Line& line : commands) outcome.text += canonical::to_text(line) + "\n";
  for (const Note& note : interpreter.notes())
    outcome.text.append("note ").append(std::to_string(note.line)).append(" ").append(note.text).append("\n");
  if (!result) outcome.error = to_string(result.error());
  return outcome;
}

TEST(Golden, JobsGiveTheirCanonicalCommands) {
  const auto jobs = jobs_in("golden");
  ASSERT_GE(jobs.size(), 8U);
  for (const fs::path& path : jobs) {
    const Outcome outcome = run(read_file(path));
    EXPECT_EQ(outcome.error, "") << path;
    EXPECT_EQ(outcome.text, read_file(fs::path(path).replace_extension(".canon"))) << path;
  }
}

TEST(Golden, BadJobsAreRefusedWithLineColumnAndReason) {
  const auto jobs = jobs_in("bad");
  ASSERT_GE(jobs.size(), 100U);
  for (const fs::path& path : jobs) {
    const std::string job = read_file(path);
    const std::string expected = job.substr(2, job.find('\n') - 2);
    EXPECT_EQ(run(job).error, expected) << path;
  }
}

}  // namespace
}  // namespace kinebus::gcode
