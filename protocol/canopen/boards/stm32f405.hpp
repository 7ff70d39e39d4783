#pragma once
// The dual-stepper board with an STM32F405: what it is known by, and its objects.

#include "protocol/canopen/two_axis_node.hpp"

namespace kinebus {

struct Stm32f405Board : TwoAxisNode<Stm32f405Board> {
  static constexpr BoardFacts kFacts{.name = "stm32f405",
                                     .order_code = "kinebus-node",
                                     .device_name = "Kinebus two-axis node",
                                     .hardware_version = "STM32F405",
                                     .description = "Kinebus two-axis CAN node",
                                     .device_type = kDeviceType,
                                     .product_code = kProductCode,
                                     .hardware = 0x0405'0001};
};

}  // namespace kinebus
