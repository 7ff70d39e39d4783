// Prints the canonical commands of a job: gcode_print FILE [FOLDER]
// FOLDER: each NAME.ngc of it is the macro NAME.

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include "gateway/gcode/canonical_text.hpp"
#include "gateway/gcode/letters.hpp"
#include "gateway/gcode/programs/job_reader.hpp"
#include "gateway/gcode/tests/golden_options.hpp"

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) {
    std::fputs("usage: gcode_print FILE [FOLDER]\n", stderr);
    return 2;
  }
  std::ifstream file(argv[1], std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) {
    std::fprintf(stderr, "%s cannot be read\n", argv[1]);
    return 2;
  }
  using namespace kinebus;
  gcode::Options options = gcode::golden_options(text);
  if (argc == 3) {
    for (const auto& entry : std::filesystem::directory_iterator(argv[2])) {
      if (entry.path().extension() != ".ngc") continue;
      std::ifstream macro(entry.path(), std::ios::binary);
      options.macros.push_back({gcode::in_lower_case(entry.path().stem().string()),
                                std::string{std::istreambuf_iterator<char>(macro), {}}});
    }
  }
  gcode::Interpreter interpreter(std::move(options));
  gcode::JobReader reader(interpreter);
  gcode::CommandBuffer commands;
  auto result = reader.read(text, commands);
  if (result) result = reader.finish(commands);
  for (const canonical::Line& line : commands) std::puts(canonical::to_text(line).c_str());
  for (const gcode::Note& note : interpreter.notes())
    std::printf("note %u %s\n", note.line, note.text.c_str());
  if (!result) std::printf("error %s\n", gcode::to_string(result.error()).c_str());
  return result ? 0 : 1;
}
