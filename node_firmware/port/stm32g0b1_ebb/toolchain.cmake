# Cross compiler for the STM32G0B1: Cortex-M0+, no FPU, no divider. Otherwise as that of the Cortex-M4 boards.
include(${CMAKE_CURRENT_LIST_DIR}/../stm32f405/toolchain.cmake)
set(KINEBUS_CORE cortex-m0plus)

set(kinebus_cpu "-mcpu=cortex-m0plus -mthumb -mfloat-abi=soft")
set(CMAKE_C_FLAGS_INIT "${kinebus_cpu} -ffunction-sections -fdata-sections")
set(CMAKE_ASM_FLAGS_INIT "${kinebus_cpu}")
set(CMAKE_CXX_FLAGS_INIT
  "${kinebus_cpu} -Wno-psabi -ffunction-sections -fdata-sections -fno-exceptions -fno-rtti -fno-threadsafe-statics")
set(CMAKE_EXE_LINKER_FLAGS_INIT "${kinebus_cpu} -Wl,--gc-sections --specs=nano.specs --specs=nosys.specs")
