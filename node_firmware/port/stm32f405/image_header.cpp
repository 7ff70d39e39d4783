// The program's own header; its length and CRC are filled in after linking (tools/build/seal_image.cpp).

#include "node_firmware/boot/image_header.hpp"

namespace kinebus {

[[gnu::section(".image_header"), gnu::used]] extern constinit const ImageHeader kImageHeader{};

}  // namespace kinebus
