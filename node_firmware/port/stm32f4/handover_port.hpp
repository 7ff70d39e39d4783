#pragma once
// Where the handover is: the first bytes of the RAM, in boot loader and program alike (sections.ld).

#include "node_firmware/boot/handover.hpp"

extern "C" kinebus::Handover handover_ram;
