#include "tools/flash/program_file.hpp"

#include <fstream>
#include <iterator>

#include "tools/flash/program_update.hpp"

namespace kinebus {

ProgramFile read_program_file(const std::string& file) {
  ProgramFile program{.file = file};
  std::ifstream in(file, std::ios::binary);
  program.bytes.assign(std::istreambuf_iterator<char>(in), {});
  if (!in && program.bytes.empty()) {
    program.trouble = "cannot read " + file;
  } else if (const ImageCheck check = check_any_image(program.bytes); check != ImageCheck::kGood) {
    program.trouble = file + ": " + what_is_wrong(check);
  } else {
    const ImageHeader header = decode_image_header(program.bytes);
    program.node_product = header.node_product_code();
    program.crc = header.crc;
  }
  return program;
}

}  // namespace kinebus
