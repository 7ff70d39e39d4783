#pragma once
// The dual-stepper board with an STM32F405: what it is known by, and its objects.

#include "protocol/canopen/object_units.hpp"

namespace kinebus {

struct Stm32f405Board {
  static constexpr BoardFacts kFacts{.name = "stm32f405",
                                     .order_code = "kinebus-node",
                                     .device_name = "Kinebus two-axis node",
                                     .hardware_version = "STM32F405",
                                     .description = "Kinebus two-axis CAN node",
                                     .device_type = 0xFFFF'0192,  // several CiA 402 axes: see 67FFh, 6FFFh
                                     .product_code = kProductCode,
                                     .hardware = 0x0405'0001};
  static constexpr object_table::PdoSet kPdos = object_table::kAxisPairPdos;

  static constexpr void compose(object_table::Rows& t) {
    object_table::device(t, kFacts, kPdos);
    object_table::program_download(t);
    object_table::stream(t);
    object_table::counters(t);
    object_table::switch_inputs(t);
    object_table::axis_pair(t);
    object_table::motors(t);
    object_table::linear_scales(t);
    object_table::touch_probes(t);
    object_table::last_reset(t);
  }
};

}  // namespace kinebus
