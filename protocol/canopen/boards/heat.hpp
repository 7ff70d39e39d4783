#pragma once
// A heat node, on whatever chip it runs: what it is known by, and its objects. It has a node id of its own,
// also when it shares a chip with axes.

#include "protocol/canopen/heat_units.hpp"

namespace kinebus {

struct HeatBoard {
  static constexpr BoardFacts kFacts{.name = "heat",
                                     .order_code = "kinebus-heat",
                                     .device_name = "Kinebus heat node",
                                     .hardware_version = "heat",
                                     .description = "Kinebus heaters, temperatures and fans on CAN",
                                     // CiA 404: analogue inputs, controllers, analogue outputs.
                                     .device_type = 0x0000'0194,
                                     .product_code = 0x0000'0404,
                                     .hardware = 0x0404'0001};
  static constexpr object_table::PdoSet kPdos = object_table::kHeatPdos;

  static constexpr void compose(object_table::Rows& t) {
    object_table::device(t, kFacts, kPdos);
    object_table::heat_supervision(t);
    object_table::temperature_inputs(t);
    object_table::heaters(t);
    object_table::fans(t);
    object_table::filament_sensors(t);
    object_table::pin_probe(t);
    object_table::accelerometer(t);
    object_table::program_download(t);
  }
};

}  // namespace kinebus
