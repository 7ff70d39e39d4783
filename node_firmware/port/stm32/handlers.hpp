#pragma once
// The interrupt handlers by name, as the vector table holds them.

extern "C" {
[[noreturn]] void reset_handler();
/// Hard fault, NMI (the crystal has stopped) and all other exceptions of the core, and interrupts without
/// handler (17: the supply is low): power off, record, reset. Only the vector table leads here.
void isr_fault();
void isr_unexpected();

void isr_tick();          ///< SysTick
void isr_switches();      ///< EXTI: time-stamps an edge
void isr_control();       ///< what moves the motors, at a steady rate
void isr_can_receive();   ///< time-stamps and queues
void isr_can_transmit();  ///< a mailbox has become free
void isr_can_state();     ///< error passive, bus-off
void isr_break_a();       ///< over-current comparator of motor A
void isr_break_b();       ///< of motor B
void isr_console();
void isr_usb();  ///< OTG_FS
}
