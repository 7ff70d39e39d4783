#pragma once
// The BTT Octopus with an STM32F446: what its axis pair is known by, and its objects. They are those of the
// dual-stepper board; what this board cannot measure stays as it is by default.

#include "protocol/canopen/object_units.hpp"

namespace kinebus {

struct Stm32f446OctopusBoard {
  static constexpr BoardFacts kFacts{.name = "stm32f446_octopus",
                                     .order_code = "kinebus-octopus-f446",
                                     .device_name = "Kinebus two-axis node on an Octopus",
                                     .hardware_version = "Octopus STM32F446",
                                     .description = "Kinebus two-axis CAN node on a BTT Octopus",
                                     .device_type = 0xFFFF'0192,  // several CiA 402 axes: see 67FFh, 6FFFh
                                     .product_code = 0x0000'0446,
                                     .hardware = 0x0446'0001};
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
