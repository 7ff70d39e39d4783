// join_images FILE BEGIN (ADDRESS IMAGE)...: images as they lie in flash from BEGIN on, as one file; between
// them it is blank. IMAGE is the name of IMAGE.bin here; IMAGE:vectors its vectors alone, up to the header.
// Runs on the machine that builds.

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "node_firmware/boot/image_header.hpp"

int main(int count, char** arguments) {
  if (count < 5 || count % 2 == 0)
    return std::fputs("usage: join_images FILE BEGIN (ADDRESS IMAGE)...\n", stderr), 2;
  const auto address = [](const char* text) {
    return static_cast<std::uint32_t>(std::strtoul(text, nullptr, 16));
  };
  const std::uint32_t begin = address(arguments[2]);
  std::vector<char> joined;
  for (int i = 3; i < count; i += 2) {
    std::string name = arguments[i + 1];
    const std::size_t colon = name.find(':');
    const bool vectors = colon != std::string::npos;
    name = name.substr(0, colon) + ".bin";
    std::ifstream in(name, std::ios::binary);
    std::vector<char> image{std::istreambuf_iterator<char>(in), {}};
    if (image.size() < kinebus::ImageHeader::kOffset)
      return std::fprintf(stderr, "join_images: %s: no image\n", name.c_str()), 1;
    if (vectors) image.resize(kinebus::ImageHeader::kOffset);
    const std::uint32_t at = address(arguments[i]) - begin;
    if (at < joined.size())
      return std::fprintf(stderr, "join_images: %s begins before the one ahead of it ends\n", name.c_str()),
             1;
    joined.resize(at, '\xFF');
    joined.insert(joined.end(), image.begin(), image.end());
  }
  std::ofstream out(arguments[1], std::ios::binary);
  out.write(joined.data(), static_cast<std::streamsize>(joined.size()));
  return out.good() ? 0 : 1;
}
