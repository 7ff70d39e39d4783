#pragma once
// The BTT Octopus with an STM32F446: what each of its four axis pairs is known by, and its objects. They are
// those of the dual-stepper board; what this board cannot measure stays as it is by default. Its fifth node
// is a heat node (boards/heat.hpp).

#include "protocol/canopen/two_axis_node.hpp"

namespace kinebus {

struct Stm32f446OctopusBoard : TwoAxisNode<Stm32f446OctopusBoard> {
  static constexpr BoardFacts kFacts{.name = "stm32f446_octopus",
                                     .order_code = "kinebus-octopus-f446",
                                     .device_name = "Kinebus two-axis node on an Octopus",
                                     .hardware_version = "Octopus STM32F446",
                                     .description = "Kinebus two-axis CAN node on a BTT Octopus",
                                     .device_type = kDeviceType,
                                     .product_code = 0x0000'0446,
                                     .hardware = 0x0446'0001,
                                     .consecutive_ids = 5};
};

}  // namespace kinebus
