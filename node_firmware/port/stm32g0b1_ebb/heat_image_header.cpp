// The header of the heat node's program; its length and CRC are filled in after linking
// (tools/build/seal_image.cpp).

#include "node_firmware/boot/image_header.hpp"
#include "protocol/canopen/boards/heat.hpp"
#include "protocol/canopen/boards/stm32g0b1_ebb.hpp"

namespace kinebus {

[[gnu::section(".image_header"), gnu::used]] extern constinit const ImageHeader kImageHeader =
    image_header_for(image_target(Stm32g0b1EbbBoard::kFacts), HeatBoard::kFacts.product_code);

}  // namespace kinebus
