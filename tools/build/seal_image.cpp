// seal_image IMAGE.bin HEADER.bin: the header of a linked image with its length and CRC filled in, for
// objcopy
// --update-section. Runs on the machine that builds.

#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>

#include "node_firmware/boot/image_header.hpp"

int main(int count, char** arguments) {
  using namespace kinebus;
  if (count != 3) return std::fputs("usage: seal_image IMAGE.bin HEADER.bin\n", stderr), 2;
  std::ifstream in(arguments[1], std::ios::binary);
  std::vector<std::uint8_t> image{std::istreambuf_iterator<char>(in), {}};
  image.resize((image.size() + 3) / 4 * 4, 0xFF);
  if (image.size() < ImageHeader::kOffset + ImageHeader::kBytes ||
      decode_image_header(image).magic != ImageHeader::kMagic)
    return std::fprintf(stderr, "seal_image: %s has no image header\n", arguments[1]), 1;
  ImageHeader header = decode_image_header(image);
  header.length = static_cast<std::uint32_t>(image.size());
  encode_image_header(header, image);
  header.crc = image_crc(image);
  encode_image_header(header, image);
  std::ofstream out(arguments[2], std::ios::binary);
  for (std::size_t i = 0; i < ImageHeader::kBytes; ++i)
    out.put(static_cast<char>(image[ImageHeader::kOffset + i]));
  return out.good() ? 0 : 1;
}
