#pragma once
// A stepper driver's module in its socket, as the pins know it that all kinds have.

#include "vcan_tests/emulator/cycle.hpp"
#include "vcan_tests/emulator/physics/driven_rotor.hpp"

namespace kinebus::emulator {

class SocketedDriver {
 public:
  virtual ~SocketedDriver() = default;
  virtual void on_enable(bool enabled) = 0;
  virtual void on_step(bool direction, Cycle now) = 0;
  virtual bool diag() const = 0;
  virtual double rotor_counts() const = 0;
  virtual DrivenRotor& rotor() = 0;  ///< of its motor
};

}  // namespace kinebus::emulator
