#include "vcan_tests/emulator/peripherals/gpio.hpp"

namespace kinebus::emulator {

void GpioPort::reset(std::uint32_t modes) {
  set_modes(modes);
  otyper_ = ospeedr_ = pupdr_ = odr_ = 0;
  afr_ = {};
}

void GpioPort::set_modes(std::uint32_t modes) {
  moder_ = modes;
  outputs_ = 0;
  for (int pin = 0; pin < 16; ++pin)
    if (mode(pin) == Mode::kOutput) outputs_ |= 1u << pin;
}

std::uint32_t GpioPort::levels() const {
  std::uint32_t word = 0;
  for (int pin = 0; pin < 16; ++pin) {
    const std::uint32_t bit = 1u << pin;
    bool high = pulled_up(pin);
    if ((driven_ & bit) != 0) high = (driven_level_ & bit) != 0;
    if (mode(pin) == Mode::kOutput && ((otyper_ & bit) == 0 || (odr_ & bit) == 0)) high = (odr_ & bit) != 0;
    if (mode(pin) == Mode::kAnalogue) high = false;
    if (high) word |= bit;
  }
  return word;
}

void GpioPort::drive(int pin, bool level) {
  driven_ |= 1u << pin;
  driven_level_ = (driven_level_ & ~(1u << pin)) | (level ? 1u << pin : 0);
}

void GpioPort::release(int pin) {
  driven_ &= ~(1u << pin);
}

std::uint32_t GpioPort::read(std::uint32_t offset, Cycle) {
  switch (offset) {
    case 0x00:
      return moder_;
    case 0x04:
      return otyper_;
    case 0x08:
      return ospeedr_;
    case 0x0C:
      return pupdr_;
    case 0x10:
      return levels();
    case 0x14:
      return odr_;
    case 0x20:
      return afr_[0];
    case 0x24:
      return afr_[1];
    default:
      return 0;
  }
}

void GpioPort::write(std::uint32_t offset, std::uint32_t value, Cycle now) {
  const std::array before{moder_, otyper_, pupdr_, odr_, afr_[0], afr_[1]};
  switch (offset) {
    case 0x00:
      set_modes(value);
      break;
    case 0x04:
      otyper_ = value;
      break;
    case 0x08:
      ospeedr_ = value;
      break;
    case 0x0C:
      pupdr_ = value;
      break;
    case 0x14:
      odr_ = value & 0xFFFF;
      break;
    case 0x18:
      odr_ = (odr_ & ~(value >> 16)) | (value & 0xFFFF);
      break;  // set wins over reset
    case 0x20:
      afr_[0] = value;
      break;
    case 0x24:
      afr_[1] = value;
      break;
    default:
      return;
  }
  const std::array after{moder_, otyper_, pupdr_, odr_, afr_[0], afr_[1]};
  if (after != before && on_change) on_change(now);
}

void Exti::reset() {
  imr_ = rtsr_ = ftsr_ = pr_ = 0;
  source_ = {};
  update();
}

void Exti::on_level(int port, int pin, bool level) {
  const auto line = static_cast<std::size_t>(pin);
  const auto bit = static_cast<std::uint16_t>(1u << port);
  const bool was = (level_[line] & bit) != 0;
  if (was == level) return;
  level_[line] = static_cast<std::uint16_t>(level ? level_[line] | bit : level_[line] & ~bit);
  if ((source_[line / 4] >> (4 * (line % 4)) & 0xF) != static_cast<std::uint32_t>(port)) return;
  if (((level ? rtsr_ : ftsr_) >> line & 1) == 0) return;
  pr_ |= 1u << line;
  update();
}

void Exti::on_inner_level(int line, bool level) {
  const std::uint32_t bit = 1u << line;
  if (((inner_level_ & bit) != 0) == level) return;
  inner_level_ ^= bit;
  if (((level ? rtsr_ : ftsr_) & bit) == 0) return;
  pr_ |= bit;
  update();
}

void Exti::update() {
  const std::uint32_t active = pr_ & imr_;
  for (int line = 0; line < 5; ++line) lines_.set_line(6 + line, (active >> line & 1) != 0);
  lines_.set_line(1, (active >> 16 & 1) != 0);  // supply detector
  lines_.set_line(23, (active & 0x03E0) != 0);
  lines_.set_line(40, (active & 0xFC00) != 0);
}

std::uint32_t Exti::read(std::uint32_t offset, Cycle) {
  switch (offset) {
    case 0x00:
      return imr_;
    case 0x08:
      return rtsr_;
    case 0x0C:
      return ftsr_;
    case 0x14:
      return pr_;
    default:
      return 0;
  }
}

void Exti::write(std::uint32_t offset, std::uint32_t value, Cycle) {
  switch (offset) {
    case 0x00:
      imr_ = value;
      break;
    case 0x08:
      rtsr_ = value;
      break;
    case 0x0C:
      ftsr_ = value;
      break;
    case 0x10:
      pr_ |= value & imr_;
      break;
    case 0x14:
      pr_ &= ~value;
      break;
    default:
      return;
  }
  update();
}

}  // namespace kinebus::emulator
