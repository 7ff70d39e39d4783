#pragma once
// The BTT EBB36 and EBB42 with an STM32G0B1: what its axis is known by, and its objects. They are those of
// the dual-stepper board; axis B is not there and has a fault when it is switched on.

#include "protocol/canopen/two_axis_node.hpp"

namespace kinebus {

struct Stm32g0b1EbbBoard : TwoAxisNode<Stm32g0b1EbbBoard> {
  static constexpr BoardFacts kFacts{.name = "stm32g0b1_ebb",
                                     .order_code = "kinebus-ebb-g0b1",
                                     .device_name = "Kinebus extruder axis on an EBB",
                                     .hardware_version = "EBB STM32G0B1",
                                     .description = "Kinebus extruder axis on a BTT EBB36 or EBB42",
                                     .device_type = kDeviceType,
                                     .product_code = 0x0000'00B1,
                                     .hardware = 0x00B1'0001};
};

}  // namespace kinebus
