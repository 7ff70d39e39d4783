#pragma once
// What exceptions.cpp asks of a chip.

#include "node_firmware/board/fault_record.hpp"

namespace kinebus::stm32 {

/// Each chip's own: the exception that runs, and what its core tells of a fault beside the stacked registers.
void record_core(FaultRecord& record);

}  // namespace kinebus::stm32
