// Prints the canonical commands of a job: gcode_print FILE

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include "gateway/gcode/canonical_text.hpp"
#include "gateway/gcode/programs/job_reader.hpp"
#include "gateway/gcode/tests/golden_options.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: gcode_print FILE\n", stderr);
    return 2;
  }
  std::ifstream file(argv[1], std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) {
    std::fprintf(stderr, "%s cannot be read\n", argv[1]);
    return 2;
  }
  using namespace kinebus;
  gcode::Interpreter interpreter(gcode::golden_options(text));
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
