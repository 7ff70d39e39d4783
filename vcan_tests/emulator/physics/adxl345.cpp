#include "vcan_tests/emulator/physics/adxl345.hpp"

namespace kinebus::emulator {
namespace {

constexpr std::uint8_t kDeviceId = 0x00, kDataRate = 0x2C, kPowerControl = 0x2D, kDataFormat = 0x31,
                       kFirstData = 0x32, kLastData = 0x37, kQueueControl = 0x38, kQueueStatus = 0x39;
constexpr std::uint8_t kMeasures = 0x08, k3200Hz = 0x0F, kFull16g = 0x0B, kStream = 0x80, kOwnId = 0xE5;
constexpr std::size_t kQueue = 32;
// Between a reading's end and the next look at the queue.
constexpr Cycle kRefill = 5 * kCoreHz / 1'000'000;

}  // namespace

void Adxl345Chip::reset() {
  registers_ = {};
  queue_.clear();
  selected_ = data_read_ = false;
}

// What the plant has measured since is queued; the oldest makes room.
void Adxl345Chip::measure(Cycle now) {
  plant_.step(seconds_of(now - measured_));
  measured_ = now;
  const auto readings = plant_.take();
  if ((registers_[kPowerControl] & kMeasures) == 0) return;
  for (const auto& reading : readings) {
    queue_.push_back(reading);
    if (queue_.size() <= kQueue) continue;
    queue_.pop_front();
    ++lost_;
  }
}

void Adxl345Chip::select(bool selected, Cycle now) {
  if (selected == selected_) return;
  selected_ = selected;
  first_ = true;
  measure(now);
  if (!selected && data_read_) read_until_ = now;
  data_read_ = false;
}

std::uint8_t Adxl345Chip::read(std::uint8_t address, Cycle now) {
  if (address == kDeviceId) return kOwnId;
  if (address == kQueueStatus) {
    if (now < read_until_ + kRefill) ++mistakes_;
    return static_cast<std::uint8_t>(queue_.size());
  }
  if (address < kFirstData || address > kLastData) return registers_[address];
  if (address == kFirstData) {
    if (now < read_until_ + kRefill) ++mistakes_;
    if (!queue_.empty()) {
      out_ = queue_.front();
      queue_.pop_front();
    }
  }
  data_read_ = true;
  const unsigned at = address - kFirstData;
  return static_cast<std::uint8_t>(static_cast<std::uint16_t>(out_[at / 2]) >> (8 * (at % 2)));
}

void Adxl345Chip::write(std::uint8_t address, std::uint8_t value, Cycle now) {
  const bool modelled = (address == kDataRate && value == k3200Hz) ||
                        (address == kPowerControl && (value & ~kMeasures) == 0) ||
                        (address == kDataFormat && value == kFull16g) ||
                        (address == kQueueControl && (value == 0 || value == kStream));
  if (!modelled) ++mistakes_;
  measure(now);
  registers_[address] = value;
  if (address == kQueueControl && value == 0) queue_.clear();
}

std::uint16_t Adxl345Chip::exchange(std::uint16_t sent, Cycle now) {
  if (!selected_ || plant_.silent) return 0xFF;
  if (first_) {
    first_ = false;
    reads_ = (sent & 0x80) != 0;
    several_ = (sent & 0x40) != 0;
    address_ = sent & 0x3F;
    return 0;
  }
  const std::uint8_t address = address_;
  if (several_) address_ = (address_ + 1) & 0x3F;
  if (reads_) return read(address, now);
  write(address, static_cast<std::uint8_t>(sent), now);
  return 0;
}

}  // namespace kinebus::emulator
