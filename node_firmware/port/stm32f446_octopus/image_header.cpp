// The program's own header; its length and CRC are filled in after linking (tools/build/seal_image.cpp).

#include "node_firmware/boot/image_header.hpp"
#include "protocol/canopen/boards/stm32f446_octopus.hpp"

namespace kinebus {

[[gnu::section(".image_header"), gnu::used]] extern constinit const ImageHeader kImageHeader =
    image_header_for(image_target(Stm32f446OctopusBoard::kFacts));

}  // namespace kinebus
